#pragma once

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/json.h"
#include "core/result.h"
#include "metrics/metric.h"
#include "results/notes.h"
#include "results/proficiency.h"
#include "results/repository.h"

namespace trocar::web {

using config::Json;
using config::or_null;

inline constexpr std::size_t kMostTextBytes = 4096;
/// A text of the body, of at most so many bytes of UTF-8. Error (exit status 2): missing, not a text, too long.
Result<std::string> text_field(const Json& body, const char* name, std::size_t most_bytes = kMostTextBytes);
/// The same, empty if it is missing or null.
Result<std::string> text_field_or_empty(const Json& body, const char* name, std::size_t most_bytes = kMostTextBytes);

/// Error (exit status 2): not an object, or a field of another name.
Status check_fields(const Json& body, std::span<const std::string_view> names);

/// To three decimals: micrometres, millinewtons.
double rounded(double value) noexcept;
std::int64_t seconds_of(results::Seconds time) noexcept;

Json note_json(const results::Note& note);
/// Path and forces; frame P (LPS, mm).
Json trace_json(const results::Trace& trace);

/// What the data folder says: titles of tasks and metrics, their order, and when a person is called proficient.
class Titles {
 public:
  /// From the data folder. Errors: those of tasks::load_tasks and learning::load_rules.
  static Result<Titles> load(const std::filesystem::path& data_folder);

  struct Task {
    std::string id, title;
  };
  const std::vector<Task>& tasks() const noexcept { return tasks_; }
  /// The title of a task; its id if it is another department's own task.
  std::string task_title(std::string_view id) const;

  struct Metric {
    std::string name, title, unit;
    metrics::Better better = metrics::Better::kNeither;
  };
  const Metric& score() const noexcept { return score_; }
  /// A metric of the catalogue; another one with this unit and its name as title if there is none.
  Metric metric(std::string_view name, std::string_view unit) const;
  const results::ProficiencyRules& proficiency() const noexcept { return proficiency_; }
  /// Position in reports; those that are not in the catalogue come last.
  std::size_t order_of(std::string_view name) const;

 private:
  std::vector<Task> tasks_;
  std::vector<Metric> metrics_;
  std::map<std::string, std::size_t, std::less<>> position_;
  results::ProficiencyRules proficiency_;
  Metric score_{"score", "Score", "points", metrics::Better::kHigher};
};

/// "lower", "higher", "neither".
const char* to_string(metrics::Better better) noexcept;

}  // namespace trocar::web
