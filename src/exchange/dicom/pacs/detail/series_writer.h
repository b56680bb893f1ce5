#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/object_files.h"
#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom::detail {

/// Which objects a series may consist of, and how they are written.
struct SeriesRules {
  std::string study_uid;
  std::string series_uid;
  Anonymisation* anonymisation = nullptr;      ///< Null: unchanged.
  std::function<bool()> is_cancelled;          ///< May be empty.
  std::function<void(std::size_t)> on_object;  ///< Called with the number of objects so far; may be empty.
};

/// Writes the objects of one series into a folder while they arrive.
class SeriesWriter final : public ObjectSink {
 public:
  /// `folder` must exist. Errors: the file for arriving objects cannot be created.
  static Result<SeriesWriter> create(const std::filesystem::path& folder, SeriesRules rules);

  Status begin() override;
  Status append(std::string_view bytes) override;
  Status end(const std::string& transfer_syntax) override;
  bool is_cancelled() const override;

  /// Names the files by the numbers of the objects. Returns their count.
  Result<std::size_t> finish();
  std::size_t skipped() const noexcept { return skipped_; }  ///< Objects of a kind that cannot be anonymised.
  bool may_show_text() const noexcept { return may_show_text_; }

 private:
  /// A written object; by these fields the files are ordered.
  struct Written {
    int number = 0;
    std::string sop_instance;
    std::filesystem::path file;
    auto operator<=>(const Written&) const = default;
  };
  SeriesWriter(std::filesystem::path folder, SeriesRules rules, ReceivedFile file);

  std::filesystem::path folder_;
  SeriesRules rules_;
  ReceivedFile file_;
  std::vector<Written> written_;
  std::set<std::string> sop_instances_;
  std::size_t skipped_ = 0;
  bool may_show_text_ = false;
};

}  // namespace trocar::dicom::detail
