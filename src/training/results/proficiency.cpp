#include "results/proficiency.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "cohort/learning_curve.h"
#include "results/notes.h"

namespace trocar::results {
namespace {

using Values = std::map<std::int64_t, double>;  ///< Of a metric, by sequence of the attempt.

Status check_rules(const ProficiencyRules& rules) {
  if (rules.score >= 0.0 && rules.score <= 100.0 && rules.passes_in_a_row >= 1 && rules.passes_in_a_row <= 20)
    return {};
  return fail_usage(fmt::format("{} passes in a row with {:g} points is no rule", rules.passes_in_a_row, rules.score),
                    "proficiency", "use 1 to 20 passes and 0 to 100 points");
}

Result<Values> values_of(Repository& repository, const std::string& task, std::string_view metric) {
  TROCAR_TRY(const std::vector<MetricSample> samples, metric_samples(repository, task, metric));
  Values values;
  for (const MetricSample& sample : samples)
    if (sample.value) values[sample.sequence] = *sample.value;
  return values;
}

std::vector<double> of_attempts(const Values& values, const std::vector<Attempt>& attempts) {
  std::vector<double> found;
  for (const Attempt& attempt : attempts)
    if (const auto value = values.find(attempt.sequence); value != values.end()) found.push_back(value->second);
  return found;
}

std::optional<double> mean_or_none(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(cohort::mean_of(values));
}

/// The cohort's figures from those of its people.
Status summarise(GroupProficiency& group) {
  std::vector<cohort::FollowUp> trials;
  std::vector<double> shares, times;
  for (const PersonProficiency& one : group.people) {
    group.counts.add(one.counts);
    group.practice_s += one.practice_s;
    const double followed = static_cast<double>(one.trials.value_or(static_cast<std::size_t>(one.counts.counted())));
    trials.push_back({followed, one.trials.has_value()});
    if (one.first_pass_share) shares.push_back(*one.first_pass_share);
    if (one.time_to_target_s) times.push_back(*one.time_to_target_s);
    if (!one.instructor_min) continue;
    group.instructor_min = group.instructor_min.value_or(0.0) + *one.instructor_min;
    ++group.taught;
  }
  TROCAR_TRY(group.trials, cohort::survival_of(trials));
  group.first_pass_share = mean_or_none(shares);
  group.time_to_target_s = cohort::quantile_of(times, 0.5);
  return {};
}

}  // namespace

std::optional<std::size_t> trials_to_proficiency(const std::vector<Attempt>& attempts, const ProficiencyRules& rules) {
  int in_a_row = 0;
  for (std::size_t n = 0; n < attempts.size(); ++n) {
    const bool is_success = attempts[n].is_passed && attempts[n].score.value_or(0.0) >= rules.score;
    in_a_row = is_success ? in_a_row + 1 : 0;
    if (in_a_row == rules.passes_in_a_row) return n + 1;
  }
  return std::nullopt;
}

Result<std::vector<GroupProficiency>> proficiency_of(Repository& repository, const ProficiencyFilter& filter,
                                                     const ProficiencyRules& rules) {
  TROCAR_TRY_STATUS(check_rules(rules));
  const AttemptFilter chosen{{}, filter.task, filter.course, filter.patient, filter.level};
  TROCAR_TRY(const std::vector<Attempt> all, list_attempts(repository, chosen));
  TROCAR_TRY(const std::vector<Person> people, list_people(repository));
  TROCAR_TRY(const Values first_passes, values_of(repository, filter.task, "first_pass_success"));
  TROCAR_TRY(const Values times, values_of(repository, filter.task, "time_to_target"));
  TROCAR_TRY(const auto minutes, teaching_minutes(repository, filter.task));
  std::map<std::string, std::vector<Attempt>> by_person;
  for (const Attempt& attempt : all) by_person[attempt.person_id].push_back(attempt);
  std::map<std::pair<Group, bool>, GroupProficiency> groups;
  for (const Person& person : people) {
    std::vector<Attempt>& attempts = by_person[person.id];
    PersonProficiency one{person, {}, {}, 0.0, {}, {}, {}};
    if (const auto taught = minutes.find(person.id); taught != minutes.end()) one.instructor_min = taught->second;
    for (const Attempt& attempt : attempts) {
      one.counts.add(ending_of(attempt.state), attempt.is_passed);
      one.practice_s += attempt.duration_s;
    }
    if (one.counts.counted() == 0) continue;
    std::erase_if(attempts, [](const Attempt& attempt) { return !learning::counts(ending_of(attempt.state)); });
    one.trials = trials_to_proficiency(attempts, rules);
    one.first_pass_share = mean_or_none(of_attempts(first_passes, attempts));
    one.time_to_target_s = cohort::quantile_of(of_attempts(times, attempts), 0.5);
    GroupProficiency& group = groups[{person.group, person.is_simulated}];
    group.group = person.group;
    group.is_simulated = person.is_simulated;
    group.people.push_back(std::move(one));
  }
  std::vector<GroupProficiency> found;
  for (auto& [key, group] : groups) {
    TROCAR_TRY_STATUS(summarise(group));
    found.push_back(std::move(group));
  }
  return found;
}

std::string instructor_time_text(const GroupProficiency& group) {
  constexpr double kMinute_s = 60.0;
  if (!group.instructor_min)
    return fmt::format(
        "none entered (trocar results taught); {:.0f} min of needle time were recorded, the most that an instructor "
        "can have watched",
        group.practice_s / kMinute_s);
  const std::size_t others = group.people.size() - group.taught;
  return fmt::format("{:.0f} min for {} {}, {:.0f} min each on average{}", *group.instructor_min, group.taught,
                     group.taught == 1 ? "person" : "people", *group.instructor_min / static_cast<double>(group.taught),
                     others > 0 ? fmt::format("; nothing was entered for {} more", others) : "");
}

namespace {

using Scores = std::vector<std::optional<double>>;
using ScoresByPerson = std::map<std::string, Scores>;

/// Scores of the chosen people, in order of recording.
template <class IsChosen>
ScoresByPerson scores_of(const std::vector<MetricSample>& samples, const IsChosen& is_chosen) {
  ScoresByPerson scores;
  for (const MetricSample& sample : samples)
    if (is_chosen(sample)) scores[sample.person_id].push_back(sample.value);
  return scores;
}

std::optional<ExpertLevel> expert_level(const std::vector<MetricSample>& samples, const std::string& person_id) {
  for (const bool is_simulated : {false, true}) {
    const ScoresByPerson scores = scores_of(samples, [&](const MetricSample& sample) {
      return sample.group == Group::kExpert && sample.is_simulated == is_simulated && sample.person_id != person_id;
    });
    std::vector<double> means;
    for (const auto& [id, of_expert] : scores)
      if (const auto mean = cohort::person_mean(of_expert)) means.push_back(*mean);
    if (means.empty()) continue;
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    return ExpertLevel{means.size(), is_simulated, cohort::mean_of(means), *low, *high};
  }
  return std::nullopt;
}

Result<std::vector<Attempt>> all_attempts(Repository& repository, const std::string& person_id, std::string_view task) {
  AttemptFilter filter;
  filter.person_id = person_id;
  filter.task = task;
  return list_attempts(repository, filter);
}

}  // namespace

Result<LearningCurve> learning_curve(Repository& repository, const Person& person, std::string_view task,
                                     const CurveRules& rules) {
  TROCAR_TRY(const std::vector<MetricSample> samples, metric_samples(repository, task, "score"));
  return learning_curve_of(repository, person, task, samples, rules);
}

Result<LearningCurve> learning_curve_of(Repository& repository, const Person& person, std::string_view task,
                                        const std::vector<MetricSample>& samples, const CurveRules& rules) {
  constexpr std::size_t kMostWindow = 1000;
  if (rules.window < 1 || rules.window > kMostWindow)
    return fail_usage(fmt::format("a moving mean of {} attempts is not within 1 and {}", rules.window, kMostWindow),
                      "learning curve", "choose another number");
  TROCAR_TRY(std::vector<Attempt> attempts, all_attempts(repository, person.id, task));
  LearningCurve curve;
  for (const Attempt& attempt : attempts) curve.counts.add(ending_of(attempt.state), attempt.is_passed);
  std::erase_if(attempts, [](const Attempt& attempt) { return !learning::counts(ending_of(attempt.state)); });
  Scores scores;
  std::vector<bool> passed;
  for (const Attempt& attempt : attempts) {
    scores.push_back(attempt.score);
    passed.push_back(attempt.is_passed);
  }
  TROCAR_TRY(curve.cusum, cohort::cusum_of(passed, rules.cusum));
  curve.trend = cohort::trend_per_attempt(scores);
  const Scores means = cohort::moving_mean(scores, rules.window);
  for (std::size_t n = 0; n < attempts.size(); ++n)
    curve.attempts.push_back({std::move(attempts[n]), means[n], curve.cusum.values[n]});
  curve.experts = expert_level(samples, person.id);
  const ScoresByPerson peers = scores_of(samples, [&](const MetricSample& sample) {
    return sample.group == Group::kTrainee && sample.is_simulated == person.is_simulated &&
           sample.person_id != person.id;
  });
  std::vector<Scores> peer_scores;
  for (const auto& [id, of_peer] : peers) peer_scores.push_back(of_peer);
  curve.peers = peer_scores.size();
  curve.peer_curve = cohort::mean_curve(peer_scores);
  return curve;
}

}  // namespace trocar::results
