#include "dicom/pacs/detail/series_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "dicom/pacs/detail/rewrite_object.h"
#include "dicom/pacs/detail/storage_classes.h"

namespace trocar::dicom::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxObjects = 100'000;  ///< Assumed: ten times the largest series in practice.

}  // namespace

SeriesWriter::SeriesWriter(fs::path folder, SeriesRules rules, ReceivedFile file)
    : folder_(std::move(folder)), rules_(std::move(rules)), file_(std::move(file)) {}

Result<SeriesWriter> SeriesWriter::create(const fs::path& folder, SeriesRules rules) {
  TROCAR_TRY(ReceivedFile file, ReceivedFile::create(folder));
  return SeriesWriter(folder, std::move(rules), std::move(file));
}

Status SeriesWriter::begin() {
  return file_.clear();
}

Status SeriesWriter::append(std::string_view bytes) {
  if (is_cancelled()) return fail("cancelled", "", "fetch it again");
  return file_.append(bytes);
}

Status SeriesWriter::end(const std::string& transfer_syntax) {
  TROCAR_TRY(const std::string_view bytes, file_.bytes());
  TROCAR_TRY(const DataSet data_set, find_data_set(bytes, transfer_syntax));
  TROCAR_TRY(const ObjectSummary summary, summarize(data_set));
  if (summary.study != rules_.study_uid || summary.series != rules_.series_uid)
    return fail("the PACS sent an object of another study or series", "", "ask its administrator to check this study");
  if (sop_instances_.contains(summary.sop_instance)) return {};  // sent twice
  if (sop_instances_.size() == kMaxObjects)
    return fail(fmt::format("the PACS sent more than {} objects", kMaxObjects), "", "fetch another series");
  sop_instances_.insert(summary.sop_instance);
  const fs::path file = folder_ / fmt::format("{}.part", sop_instances_.size());
  if (rules_.anonymisation == nullptr) {
    TROCAR_TRY_STATUS(write_unchanged(data_set, summary, file));
  } else if (can_anonymise(summary.sop_class)) {
    TROCAR_TRY_STATUS(write_anonymised(data_set, summary, *rules_.anonymisation, file));
  } else {
    ++skipped_;
    return {};
  }
  may_show_text_ |= summary.may_show_text;
  written_.push_back({summary.instance_number.value_or(0), summary.sop_instance, file});
  if (rules_.on_object) rules_.on_object(written_.size());
  return {};
}

bool SeriesWriter::is_cancelled() const {
  return rules_.is_cancelled && rules_.is_cancelled();
}

Result<std::size_t> SeriesWriter::finish() {
  std::ranges::sort(written_);
  for (std::size_t n = 0; n < written_.size(); ++n) {
    std::error_code error;
    const fs::path name = folder_ / fmt::format("{:05}.dcm", n + 1);
    fs::rename(written_[n].file, name, error);
    if (error) return fail("cannot be written: " + error.message(), name.string(), "choose another folder");
  }
  return written_.size();
}

}  // namespace trocar::dicom::detail
