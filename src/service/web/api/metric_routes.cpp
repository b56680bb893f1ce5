// Distributions of a metric by group, the evidence that scores mean something, and trials to proficiency.
#include <algorithm>
#include <map>

#include "cohort/separation.h"
#include "results/attempts.h"
#include "results/proficiency.h"
#include "results/validity.h"
#include "web/api/route.h"

namespace trocar::web {
namespace {

constexpr std::size_t kBins = 20;

Json metric_json(const Titles::Metric& metric) {
  return {{"name", metric.name}, {"title", metric.title}, {"unit", metric.unit}, {"better", to_string(metric.better)}};
}

Result<HttpAnswer> list_metrics(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string task, query_task(call.request));
  return cached(backend.statistics, backend.repositories, "metrics\n" + task, call.now, "task",
                [=, &backend](results::Repository& repository) -> Result<std::optional<Json>> {
                  TROCAR_TRY(std::vector<results::StoredMetric> stored, results::list_metrics(repository, task));
                  std::stable_sort(stored.begin(), stored.end(), [&](const auto& a, const auto& b) {
                    return backend.titles.order_of(a.name) < backend.titles.order_of(b.name);
                  });
                  Json list = Json::array({metric_json(backend.titles.score())});
                  for (const results::StoredMetric& one : stored)
                    list.push_back(metric_json(backend.titles.metric(one.name, one.unit)));
                  return std::optional<Json>(Json::object({{"metrics", std::move(list)}}));
                });
}

using Samples = std::vector<results::MetricSample>;
using GroupKey = std::pair<results::Group, bool>;  ///< And whether they are simulated.

/// A person counts once, with the mean of the attempts: those of one person are not independent.
struct PersonValue {
  GroupKey group;
  double mean = 0.0;
  std::size_t attempts = 0;
};
using People = std::vector<PersonValue>;

People people_of(const Samples& samples) {
  std::map<std::string, std::pair<GroupKey, std::vector<std::optional<double>>>> by_person;
  for (const results::MetricSample& sample : samples) {
    auto& [group, values] = by_person[sample.person_id];
    group = {sample.group, sample.is_simulated};
    if (sample.value) values.push_back(sample.value);
  }
  People people;
  for (const auto& [id, of_person] : by_person)
    if (const auto mean = cohort::person_mean(of_person.second))
      people.push_back({of_person.first, *mean, of_person.second.size()});
  return people;
}

/// Borders of bins of equal width over all values.
std::vector<double> edges_of(const People& people) {
  if (people.empty()) return {};
  const auto [low, high] =
      std::minmax_element(people.begin(), people.end(), [](const auto& a, const auto& b) { return a.mean < b.mean; });
  if (low->mean >= high->mean) return {low->mean - 0.5, low->mean + 0.5};
  std::vector<double> edges;
  for (std::size_t n = 0; n < kBins; ++n)
    edges.push_back(low->mean + (high->mean - low->mean) * static_cast<double>(n) / static_cast<double>(kBins));
  edges.push_back(high->mean);
  return edges;
}

std::vector<std::size_t> counts_of(const std::vector<double>& values, const std::vector<double>& edges) {
  std::vector<std::size_t> counts(edges.size() - 1, 0);
  for (const double value : values) {
    const auto above = std::upper_bound(edges.begin(), edges.end(), value);
    const auto bin = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - edges.begin() - 1, 0));
    ++counts[std::min(bin, counts.size() - 1)];
  }
  return counts;
}

Json groups_json(const People& people, const std::vector<double>& edges) {
  std::map<GroupKey, std::vector<double>> values;
  std::map<GroupKey, std::size_t> attempts;
  for (const PersonValue& person : people) {
    values[person.group].push_back(person.mean);
    attempts[person.group] += person.attempts;
  }
  Json groups = Json::array();
  for (const auto& [key, of_group] : values) {
    const cohort::Quartiles quartiles = *cohort::quartiles_of(of_group);
    groups.push_back({{"group", results::to_string(key.first)},
                      {"simulated", key.second},
                      {"n", of_group.size()},
                      {"attempts", attempts[key]},
                      {"counts", counts_of(of_group, edges)},
                      {"min", quartiles.min},
                      {"q1", quartiles.q1},
                      {"median", quartiles.median},
                      {"q3", quartiles.q3},
                      {"max", quartiles.max}});
  }
  return groups;
}

cohort::Better better_of(metrics::Better better) {
  if (better == metrics::Better::kLower) return cohort::Better::kLower;
  return better == metrics::Better::kHigher ? cohort::Better::kHigher : cohort::Better::kNeither;
}

const char* better_text(cohort::Better better) noexcept {
  if (better == cohort::Better::kLower) return "lower";
  return better == cohort::Better::kHigher ? "higher" : "neither";
}

/// Whether both groups have real people: then simulated ones are left out, as in results::validity_of.
bool has_real_groups(const People& people) {
  const auto has_real = [&](results::Group group) {
    return std::any_of(people.begin(), people.end(), [&](const PersonValue& person) {
      return person.group == GroupKey{group, false};
    });
  };
  return has_real(results::Group::kExpert) && has_real(results::Group::kTrainee);
}

Result<cohort::Separation> separation_of(const People& people, metrics::Better better) {
  const bool is_real_only = has_real_groups(people);
  std::vector<double> experts, novices;
  for (const PersonValue& person : people) {
    const auto& [group, is_simulated] = person.group;
    if (!is_real_only || !is_simulated) (group == results::Group::kExpert ? experts : novices).push_back(person.mean);
  }
  return cohort::separation_of(experts, novices, better_of(better));
}

Json distribution_json(const Titles::Metric& metric, const Samples& samples) {
  Json json = metric_json(metric);
  const People people = people_of(samples);
  const std::vector<double> edges = edges_of(people);
  json["edges"] = edges;
  json["groups"] = groups_json(people, edges);
  json["auc"] = nullptr;
  json["reason"] = nullptr;
  if (const auto separation = separation_of(people, metric.better)) {
    json["auc"] = {
        {"value", separation->auc}, {"low", separation->auc_interval.low}, {"high", separation->auc_interval.high}};
  } else {
    json["reason"] = separation.error().what;
  }
  return json;
}

/// The unit of a metric that attempts at the task have; empty: they have no such metric.
Result<std::optional<std::string>> find_unit(Backend& backend, const std::string& task, const std::string& name) {
  if (name == backend.titles.score().name) return std::optional(backend.titles.score().unit);
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::vector<results::StoredMetric> stored, results::list_metrics(*repository, task));
  for (const results::StoredMetric& one : stored)
    if (one.name == name) return std::optional(one.unit);
  return std::optional<std::string>();
}

Result<std::optional<Json>> load_distribution(Backend& backend, const std::string& name, const std::string& task,
                                              const std::string& course, const Moment& now) {
  TROCAR_TRY(const std::optional<std::string> unit, find_unit(backend, task, name));
  if (!unit) return std::optional<Json>();
  TROCAR_TRY(const SampleCache::Value samples, samples_of(backend, task, name, course, now));
  return std::optional<Json>(distribution_json(backend.titles.metric(name, *unit), *samples));
}

Result<HttpAnswer> show_distribution(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string task, query_task(call.request));
  TROCAR_TRY(const std::string course, query_course(call.request));
  const std::string name = call.names[0];
  return cached(
      backend.statistics, "metric\n" + name + "\n" + task + "\n" + course, call.now, "metric",
      [&backend, name, task, course, now = call.now] { return load_distribution(backend, name, task, course, now); });
}

Json separated_json(const cohort::MetricValidity& metric) {
  Json json = {
      {"name", metric.name}, {"title", metric.title}, {"unit", metric.unit}, {"better", better_text(metric.better)}};
  const auto& found = metric.separation;
  const auto or_missing = [&](auto value) { return found ? Json(value()) : Json(nullptr); };
  json["n_expert"] = or_missing([&] { return found->experts; });
  json["n_novice"] = or_missing([&] { return found->novices; });
  json["expert_median"] = or_missing([&] { return found->expert_median; });
  json["novice_median"] = or_missing([&] { return found->novice_median; });
  json["auc"] = or_missing([&] { return found->auc; });
  json["low"] = or_missing([&] { return found->auc_interval.low; });
  json["high"] = or_missing([&] { return found->auc_interval.high; });
  json["p"] = or_missing([&] { return found->test.p; });
  json["p_corrected"] = or_missing([&] { return metric.corrected_p; });
  json["discriminates"] = or_missing([&] { return metric.discriminates; });
  json["reason"] = found ? Json(nullptr) : Json(found.error().what);
  return json;
}

Json discriminating_json(const cohort::Validity& validity) {
  if (validity.tested == 0)
    return {{"share", nullptr}, {"count", nullptr}, {"of", 0}, {"reason", "no metric has values of both groups"}};
  return {{"share", static_cast<double>(validity.discriminating) / static_cast<double>(validity.tested)},
          {"count", validity.discriminating},
          {"of", validity.tested},
          {"uncorrected", validity.uncorrected},
          {"note",
           cohort::smallest_p_text(validity.experts, validity.novices, validity.tested, cohort::ValidityRules().level)},
          {"reason", nullptr}};
}

Json alpha_json(const Result<cohort::Alpha>& alpha) {
  if (!alpha)
    return {{"value", nullptr}, {"low", nullptr}, {"high", nullptr},
            {"items", nullptr}, {"n", nullptr},   {"reason", alpha.error().what}};
  return {{"value", alpha->value}, {"low", alpha->interval.low}, {"high", alpha->interval.high},
          {"items", alpha->items}, {"n", alpha->people},         {"reason", nullptr}};
}

Json pass_mark_json(const Result<cohort::PassMark>& mark) {
  if (!mark)
    return {{"value", nullptr},   {"false_passes", nullptr}, {"false_fails", nullptr},
            {"experts", nullptr}, {"novices", nullptr},      {"reason", mark.error().what}};
  return {{"value", mark->value},
          {"false_passes", mark->false_passes},
          {"false_fails", mark->false_fails},
          {"experts", mark->experts.people},
          {"novices", mark->novices.people},
          {"reason", nullptr}};
}

Json texts_json(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(text);
  return list;
}

Json validity_json(const results::EvidenceFilter& filter, const cohort::Validity& validity,
                   const results::EvidenceChoices& choices, const learning::AttemptCounts& counts) {
  Json metrics = Json::array();
  for (const cohort::MetricValidity& metric : validity.metrics) metrics.push_back(separated_json(metric));
  return {{"task", filter.task},
          {"patients", texts_json(choices.patients)},
          {"levels", texts_json(choices.levels)},
          {"counts_text", learning::counts_text(counts)},
          {"expert_attempts", validity.expert_attempts},
          {"novice_attempts", validity.novice_attempts},
          {"expert_unscored", validity.expert_unscored},
          {"novice_unscored", validity.novice_unscored},
          {"experts", validity.experts},
          {"novices", validity.novices},
          {"simulated", validity.simulated > 0},
          {"score", separated_json(validity.score)},
          {"passed", separated_json(validity.passes)},
          {"metrics", std::move(metrics)},
          {"discriminating", discriminating_json(validity)},
          {"alpha", alpha_json(validity.alpha)},
          {"pass_mark", pass_mark_json(validity.pass_mark)}};
}

Result<Json> load_validity(results::Repository& repository, const results::EvidenceFilter& filter) {
  TROCAR_TRY(const cohort::Validity validity, results::validity_of(repository, filter));
  TROCAR_TRY(const results::EvidenceChoices choices, results::evidence_choices(repository, filter.task));
  TROCAR_TRY(const learning::AttemptCounts counts,
             results::count_attempts(repository, {{}, filter.task, filter.course, filter.patient, filter.level}));
  return validity_json(filter, validity, choices, counts);
}

Result<HttpAnswer> show_validity(Backend& backend, const Call& call) {
  results::EvidenceFilter filter;
  TROCAR_TRY(filter.task, query_task(call.request));
  TROCAR_TRY(filter.course, query_course(call.request));
  TROCAR_TRY(filter.patient, query_patient(call.request));
  TROCAR_TRY(filter.level, query_level(call.request));
  const std::string key =
      "validity\n" + filter.task + "\n" + filter.course + "\n" + filter.patient + "\n" + filter.level;
  return cached(backend.statistics, backend.repositories, key, call.now, "task",
                [=](results::Repository& repository) -> Result<std::optional<Json>> {
                  TROCAR_TRY(Json json, load_validity(repository, filter));
                  return std::optional<Json>(std::move(json));
                });
}

Json proficiency_json(const results::GroupProficiency& group) {
  Json people = Json::array();
  for (const results::PersonProficiency& one : group.people)
    people.push_back({{"id", one.person.id},
                      {"name", one.person.name},
                      {"attempts", one.counts.counted()},
                      {"passed", one.counts.passed},
                      {"trials", or_null(one.trials)},
                      {"practice_s", rounded(one.practice_s)},
                      {"first_pass_share", or_null(one.first_pass_share)},
                      {"time_to_target_s", or_null(one.time_to_target_s)},
                      {"instructor_min", or_null(one.instructor_min)}});
  Json curve = Json::array();
  for (const cohort::Survival::Step& step : group.trials.steps)
    curve.push_back({{"trials", step.time}, {"at_risk", step.at_risk}, {"open_share", step.open_share}});
  return {{"group", results::to_string(group.group)},
          {"simulated", group.is_simulated},
          {"counts_text", learning::counts_text(group.counts)},
          {"people_count", group.trials.people},
          {"proficient", group.trials.reached},
          {"not_yet", group.trials.censored()},
          {"median", or_null(group.trials.median)},
          {"low", or_null(group.trials.low)},
          {"high", or_null(group.trials.high)},
          {"curve", std::move(curve)},
          {"practice_s", rounded(group.practice_s)},
          {"instructor", results::instructor_time_text(group)},
          {"instructor_min", or_null(group.instructor_min)},
          {"first_pass_share", or_null(group.first_pass_share)},
          {"time_to_target_s", or_null(group.time_to_target_s)},
          {"people", std::move(people)}};
}

Result<HttpAnswer> show_proficiency(Backend& backend, const Call& call) {
  results::ProficiencyFilter filter;
  TROCAR_TRY(filter.task, query_task(call.request));
  TROCAR_TRY(filter.course, query_course(call.request));
  TROCAR_TRY(filter.patient, query_patient(call.request));
  TROCAR_TRY(filter.level, query_level(call.request));
  const std::string key =
      "proficiency\n" + filter.task + "\n" + filter.course + "\n" + filter.patient + "\n" + filter.level;
  const results::ProficiencyRules rules = backend.titles.proficiency();
  return cached(backend.statistics, backend.repositories, key, call.now, "task",
                [=](results::Repository& repository) -> Result<std::optional<Json>> {
                  TROCAR_TRY(const auto groups, results::proficiency_of(repository, filter, rules));
                  TROCAR_TRY(const results::EvidenceChoices choices,
                             results::evidence_choices(repository, filter.task));
                  Json list = Json::array();
                  for (const results::GroupProficiency& group : groups) list.push_back(proficiency_json(group));
                  return std::optional<Json>(Json{{"task", filter.task},
                                                  {"score", rules.score},
                                                  {"passes_in_a_row", rules.passes_in_a_row},
                                                  {"patients", texts_json(choices.patients)},
                                                  {"levels", texts_json(choices.levels)},
                                                  {"groups", std::move(list)}});
                });
}

}  // namespace

std::vector<Route> metric_routes() {
  return {
      {"GET", "/api/metrics", Access::kInstructor, list_metrics},
      {"GET", "/api/metrics/*", Access::kInstructor, show_distribution},
      {"GET", "/api/validity", Access::kInstructor, show_validity},
      {"GET", "/api/proficiency", Access::kInstructor, show_proficiency},
  };
}

}  // namespace trocar::web
