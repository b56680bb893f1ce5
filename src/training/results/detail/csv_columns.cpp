#include "results/detail/csv_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "config/toml.h"
#include "metrics/metric.h"
#include "results/attempts_csv.h"

namespace trocar::results::detail {
namespace {

constexpr const char* kUseExport = "use a file of trocar results export";

bool is_known(std::string_view column) {
  const auto is_of = [&](std::string_view kind) {
    return column.starts_with(kind) && is_column_of(kind, column.substr(kind.size()));
  };
  return std::ranges::find(kAttemptColumns, column) != kAttemptColumns.end() || is_of(kPartColumn) ||
         is_of(kMetricColumn);
}

/// "path_length (mm)"
Measure measure_of(std::string_view column) {
  const std::size_t unit = column.rfind(kBeforeUnit);
  if (unit == std::string_view::npos || !column.ends_with(')')) return {std::string(column), {}, 0.0};
  const std::size_t begin = unit + kBeforeUnit.size();
  return {std::string(column.substr(0, unit)), std::string(column.substr(begin, column.size() - begin - 1)), 0.0};
}

std::optional<metrics::MetricDescription> find_known(std::string_view metric) {
  for (const metrics::MetricDescription& known : metrics::metric_catalogue())
    if (metric == known.name) return known;
  return std::nullopt;
}

/// A metric of the catalogue in another unit, or one that is spelled almost like one of it; empty: neither. Others are
/// of another version of the program.
std::string fault_of_metric(const Measure& column) {
  std::vector<std::string_view> names;
  for (const metrics::MetricDescription& known : metrics::metric_catalogue()) {
    if (column.name == known.name) return column.unit == known.unit ? "" : fmt::format("its unit is {}", known.unit);
    names.emplace_back(known.name);
  }
  const std::string_view nearest = config::nearest_word(column.name, names);
  return nearest.empty() ? std::string() : fmt::format("did you mean \"{}\"?", nearest);
}

}  // namespace

bool is_column_of(std::string_view kind, std::string_view name) {
  return (kind == kPartColumn || kind == kMetricColumn) && !name.empty() && name.front() != ' ' && name.front() != '(';
}

std::string metric_column(std::string_view name, std::string_view unit) {
  return fmt::format("{}{}{}{})", kMetricColumn, name, kBeforeUnit, unit);
}

Result<CsvColumns> CsvColumns::read(const config::CsvRow& header, const std::string& where) {
  const std::string place = fmt::format("{}, line {}", where, header.line);
  CsvColumns columns;
  for (const std::string& field : header.fields) columns.names_.push_back(config::plain_text(field));
  TROCAR_TRY_STATUS(columns.place_names(place));
  TROCAR_TRY_STATUS(columns.add_metrics(place));
  TROCAR_TRY_STATUS(columns.check_complete(where));
  return columns;
}

Status CsvColumns::place_names(const std::string& place_of_header) {
  for (std::size_t n = 0; n < names_.size(); ++n) {
    if (!is_known(names_[n]))
      return fail(fmt::format("there is no column \"{}\"", names_[n]), place_of_header,
                  "correct its name, or remove it");
    if (!places_.emplace(names_[n], n).second)
      return fail(fmt::format("the column \"{}\" occurs twice", names_[n]), place_of_header, "remove one");
  }
  for (std::size_t n = 0; n < kAttemptColumns.size(); ++n)
    if (const auto found = places_.find(kAttemptColumns[n]); found != places_.end()) fixed_[n] = found->second;
  return {};
}

Status CsvColumns::add_metrics(const std::string& place_of_header) {
  std::set<std::string> metrics;
  for (const auto& [name, place] : places_) {
    if (!name.starts_with(kMetricColumn)) continue;
    const std::string shown = name.substr(kMetricColumn.size());
    Measure metric = measure_of(shown);
    if (const std::string fault = fault_of_metric(metric); !fault.empty())
      return fail(fmt::format("the metric \"{}\" is unknown: {}", shown, fault), place_of_header,
                  "correct it, or remove the column");
    if (!metrics.insert(metric.name).second)
      return fail(fmt::format("the metric of the column \"{}\" occurs twice", name), place_of_header,
                  "leave the unit in which it is measured");
    auto known = find_known(metric.name);
    metrics_.push_back({std::move(metric), place, std::move(known)});
  }
  return {};
}

Status CsvColumns::check_complete(const std::string& where) {
  for (const char* column : {"attempt", "person", "group", "task", "started_utc", "state"})
    if (!places_.contains(column)) return fail(fmt::format("the column \"{}\" is missing", column), where, kUseExport);
  for (const auto& [name, place] : places_) {
    if (!name.starts_with(kPartColumn) || name.ends_with(kOfMost)) continue;
    const auto most = places_.find(name + std::string(kOfMost));
    if (most == places_.end())
      return fail(fmt::format("the column \"{}{}\" is missing", name, kOfMost), where, kUseExport);
    parts_.push_back({name.substr(kPartColumn.size()), place, most->second});
  }
  return {};
}

}  // namespace trocar::results::detail
