#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/csv.h"
#include "metrics/metric.h"
#include "results/attempt.h"

namespace trocar::results::detail {

/// How the names of the columns of parts and of metrics begin; the most points of a part have a column "part NAME of",
/// a metric has its unit in parentheses.
inline constexpr std::string_view kPartColumn = "part ", kMetricColumn = "metric ", kOfMost = " of", kBeforeUnit = " (";

/// Whether a part or a metric of this name can have a column.
bool is_column_of(std::string_view kind, std::string_view name);
std::string metric_column(std::string_view name, std::string_view unit);

/// Columns before those of parts and metrics, in the order of results::kAttemptColumns.
enum class Column {
  kAttempt,
  kPerson,
  kGroup,
  kSimulated,
  kCourse,
  kTask,
  kPatient,
  kSeed,
  kHash,
  kCase,
  kLevel,
  kOperator,
  kStation,
  kStarted,
  kState,
  kScore,
  kPassed,
  kDuration,
  kVersion
};

/// Places of the columns of a file with attempts.
class CsvColumns {
 public:
  /// Reads the first row. Errors: an unknown, missing or repeated column, a metric in another unit or one that is
  /// spelled almost like one of the catalogue.
  static Result<CsvColumns> read(const config::CsvRow& header, const std::string& where);

  struct Part {
    std::string name;
    std::size_t points, of_most;  ///< Places.
  };
  struct Metric {
    Measure measure;  ///< Name and unit.
    std::size_t place;
    std::optional<metrics::MetricDescription> known;  ///< Empty: of another version of the program.
  };
  std::size_t size() const noexcept { return names_.size(); }
  const std::string& name(std::size_t place) const { return names_[place]; }
  std::optional<std::size_t> find(Column column) const { return fixed_[static_cast<std::size_t>(column)]; }
  const std::vector<Part>& parts() const noexcept { return parts_; }
  const std::vector<Metric>& metrics() const noexcept { return metrics_; }

 private:
  Status place_names(const std::string& place_of_header);
  Status add_metrics(const std::string& place_of_header);
  Status check_complete(const std::string& where);

  std::vector<std::string> names_;
  std::map<std::string, std::size_t, std::less<>> places_;
  std::array<std::optional<std::size_t>, 19> fixed_;
  std::vector<Part> parts_;
  std::vector<Metric> metrics_;
};

}  // namespace trocar::results::detail
