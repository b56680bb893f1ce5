#include "dicom/pacs/fetch_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/text.h"
#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/object_files.h"
#include "dicom/pacs/detail/rewrite_object.h"
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

namespace trocar::dicom {
namespace fs = std::filesystem;
namespace {

using namespace detail;

struct NumberedSeries {
  std::size_t number = 0;
  SeriesEntry entry;
};

/// Kinds of series that hold no images, contours or segmentations.
bool has_nothing_to_use(std::string_view modality) {
  constexpr auto kOthers = std::to_array<std::string_view>(
      {"SR", "KO", "PR", "DOC", "ECG", "HD", "AU", "FID", "REG", "RTPLAN", "RTRECORD", "RTDOSE", "RWV", "PLAN"});
  return std::ranges::find(kOthers, modality) != kOthers.end();
}

/// Capital letters and digits alone: a modality comes from the PACS and becomes a part of a path.
std::string safe_name(std::string_view modality) {
  std::string name;
  for (const char c : modality)
    if (name.size() < 16 && ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) name += c;
  return name.empty() ? "OT" : name;
}

std::string images_text(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "image" : "images");
}

Result<NumberedSeries> find_wanted(const std::vector<SeriesEntry>& all, const std::string& wanted) {
  const auto number = parse_number<std::size_t>(wanted);
  if (number && *number >= 1 && *number <= all.size()) return NumberedSeries{*number, all[*number - 1]};
  const auto found = std::ranges::find(all, wanted, &SeriesEntry::uid);
  if (found != all.end()) return NumberedSeries{static_cast<std::size_t>(found - all.begin()) + 1, *found};
  return fail_usage(fmt::format("the study has no series \"{}\"; it has {}", wanted, all.size()), "--series",
                    "see the numbers and UIDs with --list");
}

Result<std::vector<NumberedSeries>> choose_series(const std::vector<SeriesEntry>& all, const FetchOptions& options,
                                                  std::vector<std::string>& warnings) {
  std::vector<NumberedSeries> chosen;
  for (const std::string& wanted : options.series) {
    TROCAR_TRY(const NumberedSeries series, find_wanted(all, wanted));
    if (std::ranges::find(chosen, series.number, &NumberedSeries::number) == chosen.end()) chosen.push_back(series);
  }
  if (!options.series.empty()) return chosen;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (has_nothing_to_use(all[n].modality))
      warnings.push_back(fmt::format("series {} ({}) is left out: it has no images", n + 1, all[n].modality));
    else
      chosen.push_back({n + 1, all[n]});
  }
  if (chosen.empty())
    return fail("the study has no series with images", options.study_uid, "choose series with --series");
  return chosen;
}

/// Retrieves one study.
class Fetch {
 public:
  Fetch(PacsSource& source, const FetchOptions& options, const Progress& progress)
      : source_(source), options_(options), progress_(progress) {}

  Result<FetchedStudy> run(const fs::path& out) {
    if (!options_.keeps_identity) TROCAR_TRY_STATUS(load_anonymisation());
    report(progress_, "asking for the series", 0.0);
    TROCAR_TRY(const std::vector<SeriesEntry> all, list_study(source_, options_.study_uid));
    TROCAR_TRY(const std::vector<NumberedSeries> chosen, choose_series(all, options_, fetched_.warnings));
    for (const NumberedSeries& series : chosen) announced_ += series.entry.images.value_or(0);
    TROCAR_TRY_STATUS(write_folder_atomically(out, [&](const fs::path& temporary) -> Status {
      for (const NumberedSeries& series : chosen)
        if (auto status = fetch_series(series, temporary); !status) return at_output(status.error(), temporary, out);
      if (fetched_.series.empty())
        return fail("the PACS sent no object that can be anonymised", options_.study_uid,
                    "choose series of images, or keep the identity");
      return {};
    }));
    note_replaced_texts();
    return std::move(fetched_);
  }

 private:
  Status load_anonymisation() {
    TROCAR_TRY(const fs::path data_folder, checked_data_dir());
    TROCAR_TRY(HarmlessWords words, HarmlessWords::load(data_folder));
    anonymisation_.emplace(Anonymisation{Pseudonyms::with_random_salt(), std::move(words), {}});
    return {};
  }

  Status fetch_series(const NumberedSeries& series, const fs::path& out) {
    const std::string name = fmt::format("series_{:03}_{}", series.number, safe_name(series.entry.modality));
    std::error_code error;
    fs::create_directory(out / name, error);
    if (error) return fail("cannot make the folder: " + error.message(), (out / name).string(), "choose another place");
    SeriesRules rules;
    rules.study_uid = options_.study_uid;
    rules.series_uid = series.entry.uid;
    rules.anonymisation = anonymisation_ ? &*anonymisation_ : nullptr;
    rules.is_cancelled = options_.is_cancelled;
    rules.on_object = [&](std::size_t count) { report_object(series, count); };
    TROCAR_TRY(SeriesWriter writer, SeriesWriter::create(out / name, std::move(rules)));
    if (auto status = source_.retrieve(options_.study_uid, series.entry.uid, writer); !status)
      return at_series(series, status.error());
    TROCAR_TRY(const std::size_t count, writer.finish());
    TROCAR_TRY_STATUS(check_count(series, count + writer.skipped()));
    received_ += count;
    note(series, writer, count);
    if (count == 0) {
      fs::remove(out / name, error);
      return {};
    }
    const std::string uid = anonymisation_ ? anonymisation_->pseudonyms.uid(series.entry.uid) : series.entry.uid;
    fetched_.series.push_back({series.number, uid, safe_name(series.entry.modality), count, name});
    return {};
  }

  /// An error of a file, with the folder that the user named in place of the temporary one.
  static Status at_output(Error error, const fs::path& temporary, const fs::path& out) {
    if (error.where.starts_with(temporary.string())) error.where = out.string();
    return tl::unexpected(std::move(error));
  }

  /// An error that arose from an object, with its series in place of a file.
  static Status at_series(const NumberedSeries& series, Error error) {
    if (error.where.empty()) error.where = fmt::format("series {}", series.number);
    return tl::unexpected(std::move(error));
  }

  /// "series 2 (CT): image 57 of 119"
  void report_object(const NumberedSeries& series, std::size_t count) const {
    const auto& images = series.entry.images;
    const double part =
        announced_ == 0 ? 0.0 : static_cast<double>(received_ + count) / static_cast<double>(announced_);
    report(progress_,
           fmt::format("series {} ({}): image {}{}", series.number, safe_name(series.entry.modality), count,
                       images ? fmt::format(" of {}", *images) : ""),
           std::min(part, 1.0));
  }

  Status check_count(const NumberedSeries& series, std::size_t count) {
    const std::size_t announced = series.entry.images.value_or(count);
    if (count == 0 || count < announced)
      return fail(fmt::format("the PACS sent {} of {}", count, images_text(std::max(announced, std::size_t{1}))),
                  fmt::format("series {}", series.number), "try again, or ask its administrator to check this study");
    if (count > announced)
      fetched_.warnings.push_back(
          fmt::format("series {}: the PACS announced {} and sent {}", series.number, images_text(announced), count));
    return {};
  }

  void note(const NumberedSeries& series, const SeriesWriter& writer, std::size_t count) {
    if (writer.skipped() > 0)
      fetched_.warnings.push_back(
          fmt::format("series {}: {} of {} objects are left out, because this kind of object cannot be anonymised",
                      series.number, writer.skipped(), writer.skipped() + count));
    if (writer.may_show_text() && !options_.keeps_identity)
      fetched_.warnings.push_back(fmt::format(
          "series {} ({}): the images may show names or dates in their pixels; look at them before you pass them on",
          series.number, safe_name(series.entry.modality)));
  }

  /// Counts only: the texts can contain names.
  void note_replaced_texts() {
    if (!anonymisation_) return;
    using Kind = TextCodes::Kind;
    const TextCodes& codes = anonymisation_->codes;
    std::vector<std::string> parts;
    const auto add = [&](Kind kind, std::string_view one, std::string_view many) {
      const std::size_t count = codes.count(kind);
      if (count > 0) parts.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
    };
    add(Kind::kSeries, "description of a series", "descriptions of series");
    add(Kind::kStructure, "name of a structure", "names of structures");
    add(Kind::kOther, "other text", "other texts");
    if (parts.empty()) return;
    fetched_.warnings.push_back(fmt::format(
        "replaced by codes, because of words that are not in harmless_words.toml: {}", fmt::join(parts, ", ")));
  }

  PacsSource& source_;
  const FetchOptions& options_;
  const Progress& progress_;
  std::optional<Anonymisation> anonymisation_;  ///< Empty: the identity is kept.
  FetchedStudy fetched_;
  std::size_t announced_ = 0;
  std::size_t received_ = 0;
};

}  // namespace

Result<std::vector<SeriesEntry>> list_study(PacsSource& source, const std::string& study_uid) {
  if (!is_uid(study_uid))
    return fail_usage(fmt::format("\"{}\" is no UID of a study", study_uid), "--study",
                      "a UID has up to 64 digits and dots");
  TROCAR_TRY(std::vector<SeriesEntry> series, source.list_series(study_uid));
  std::erase_if(series, [](const SeriesEntry& entry) { return !is_uid(entry.uid); });
  if (series.empty())
    return fail("the PACS has no such study", study_uid, "check the UID, or search for it with --patient-id");
  std::ranges::sort(series, {},
                    [](const SeriesEntry& entry) { return std::pair(entry.number.value_or(0), entry.uid); });
  return series;
}

Result<FetchedStudy> fetch_study(PacsSource& source, const FetchOptions& options, const fs::path& out,
                                 const Progress& progress) {
  return Fetch(source, options, progress).run(out);
}

}  // namespace trocar::dicom

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
