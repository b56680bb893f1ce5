#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/attempt.h"

namespace trocar::results {

/// Writes that an attempt has begun (state running). Repeating it changes nothing.
Status begin_attempt(Repository& repository, const Attempt& attempt);
/// Removes an attempt that has begun and recorded nothing; others stay.
Status forget_begun_attempt(Repository& repository, std::string_view id);
/// Writes an attempt with all its data; one with the same id that is running or interrupted is completed, one that has
/// ended stays as it is. A finished attempt without a score becomes kUnscored, or kNeverBegan if it has no puncture of
/// the skin among its measures. `recording`: bytes of the session file; empty: not kept. Returns its sequence.
/// Error (exit status 2): no such person.
Result<std::int64_t> record_attempt(Repository& repository, const AttemptRecord& record, std::string_view recording);
/// The same. Returns whether it was written: false if it had ended already, also where another program has recorded it
/// at the same time.
Result<bool> record_missing_attempt(Repository& repository, const AttemptRecord& record, std::string_view recording);
/// Many at once in one transaction, without recordings: for imports and measurements.
Status record_attempts(Repository& repository, const std::vector<AttemptRecord>& records);

/// Which attempts. Empty members do not restrict.
struct AttemptFilter {
  std::string person_id = {}, task = {}, course = {};
  std::string patient = {}, level = {};     ///< "biopsy-2"; "exam".
  std::optional<std::int64_t> before = {};  ///< Only with a smaller sequence.
  std::size_t limit = 0;                    ///< The newest so many; 0: all.
  bool is_newest_first = false;
  std::optional<State> state = {};
};
Result<std::vector<Attempt>> list_attempts(Repository& repository, const AttemptFilter& filter);
/// How many of them count, and why the others do not. Order, limit and `before` of the filter are ignored.
Result<learning::AttemptCounts> count_attempts(Repository& repository, const AttemptFilter& filter);
Result<std::optional<Attempt>> find_attempt(Repository& repository, std::string_view id);
/// With parts, measures, hints and trace. Empty: no such attempt.
Result<std::optional<AttemptRecord>> load_attempt(Repository& repository, std::string_view id);
/// Empty: no such attempt, or its recording is not kept.
Result<std::optional<std::string>> load_recording(Repository& repository, std::string_view id);
/// The id of the best attempt of an expert on the same case (of a simulated one only if there is no other); empty:
/// none.
Result<std::optional<std::string>> find_expert_attempt(Repository& repository, const Attempt& attempt);
/// Deletes an attempt permanently. Returns whether it is erased everywhere; see erase_deleted.
Result<bool> delete_attempt(Repository& repository, std::string_view id);

/// Past attempts of a person for the learning path, by sequence.
Result<std::vector<learning::PastAttempt>> past_attempts(Repository& repository, std::string_view person_id);

/// One person at one task.
struct TaskSummary {
  std::string person_id, task;
  learning::AttemptCounts counts;
  std::optional<double> last_score, best_score;
  std::optional<double> recent_mean;  ///< Of the last kRecentAttempts scored ones.
  Seconds last{};
};
inline constexpr int kRecentAttempts = 5;
/// `person_id` empty: of all people.
Result<std::vector<TaskSummary>> summarise_tasks(Repository& repository, std::string_view person_id = {});

/// The value of a metric in one attempt that counts, or its score (metric "score").
struct MetricSample {
  std::string person_id;
  Group group = Group::kTrainee;
  bool is_simulated = false;
  std::int64_t sequence = 0;
  std::optional<double> value;  ///< Empty: its score, if it ended without one.
};
/// By sequence. An attempt that has no value of a metric is left out, one without a score is not. `course`: empty: all.
Result<std::vector<MetricSample>> metric_samples(Repository& repository, std::string_view task, std::string_view metric,
                                                 std::string_view course = {});
/// Metrics that attempts at a task have a value of, by name; with the unit.
struct StoredMetric {
  std::string name, unit;
};
Result<std::vector<StoredMetric>> list_metrics(Repository& repository, std::string_view task);

/// Means of a metric of each expert over the attempts that count: of real experts; of simulated ones if the task has no
/// others. Each expert counts once. `without`: a person who is compared with the others; empty: none.
struct ExpertMeasures {
  std::string metric;
  std::vector<double> values;  ///< One an expert.
};
Result<std::vector<ExpertMeasures>> expert_measures(Repository& repository, std::string_view task,
                                                    std::string_view without = {});

}  // namespace trocar::results
