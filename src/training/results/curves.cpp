#include "results/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

namespace trocar::results {
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
