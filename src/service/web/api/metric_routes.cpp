// Distributions of a metric by group, and the evidence that scores mean something.
#include <algorithm>
#include <map>

#include "cohort/separation.h"
#include "results/attempts.h"
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

/// Borders of bins of equal width over all values.
std::vector<double> edges_of(const Samples& samples) {
  if (samples.empty()) return {};
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end(),
                                               [](const auto& a, const auto& b) { return a.value < b.value; });
  if (low->value >= high->value) return {low->value - 0.5, low->value + 0.5};
  std::vector<double> edges;
  for (std::size_t n = 0; n < kBins; ++n)
    edges.push_back(low->value + (high->value - low->value) * static_cast<double>(n) / static_cast<double>(kBins));
  edges.push_back(high->value);
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

Json groups_json(const Samples& samples, const std::vector<double>& edges) {
  std::map<GroupKey, std::vector<double>> values;
  for (const results::MetricSample& sample : samples)
    values[{sample.group, sample.is_simulated}].push_back(sample.value);
  Json groups = Json::array();
  for (const auto& [key, of_group] : values) {
    const cohort::Quartiles quartiles = *cohort::quartiles_of(of_group);
    groups.push_back({{"group", results::to_string(key.first)},
                      {"simulated", key.second},
                      {"n", of_group.size()},
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

/// Whether both groups have real people: then simulated ones are left out, as in results::validity_of.
bool has_real_groups(const Samples& samples) {
  const auto has_real = [&](results::Group group) {
    return std::any_of(samples.begin(), samples.end(),
                       [&](const auto& sample) { return sample.group == group && !sample.is_simulated; });
  };
  return has_real(results::Group::kExpert) && has_real(results::Group::kTrainee);
}

/// Of the people's means: attempts of one person are not independent.
Result<cohort::Separation> separation_of(const Samples& samples, metrics::Better better) {
  const bool is_real_only = has_real_groups(samples);
  std::map<std::pair<results::Group, std::string>, std::vector<std::optional<double>>> by_person;
  for (const results::MetricSample& sample : samples)
    if (!is_real_only || !sample.is_simulated) by_person[{sample.group, sample.person_id}].emplace_back(sample.value);
  std::vector<double> experts, novices;
  for (const auto& [key, values] : by_person)
    (key.first == results::Group::kExpert ? experts : novices).push_back(*cohort::person_mean(values));
  return cohort::separation_of(experts, novices, better_of(better));
}

Json distribution_json(const Titles::Metric& metric, const Samples& samples) {
  Json json = metric_json(metric);
  const std::vector<double> edges = edges_of(samples);
  json["edges"] = edges;
  json["groups"] = groups_json(samples, edges);
  json["auc"] = nullptr;
  json["reason"] = nullptr;
  if (const auto separation = separation_of(samples, metric.better)) {
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
  Json json = {{"name", metric.name}, {"title", metric.title}, {"unit", metric.unit}};
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

Json validity_json(const std::string& task, const cohort::Validity& validity) {
  Json metrics = Json::array();
  for (const cohort::MetricValidity& metric : validity.metrics) metrics.push_back(separated_json(metric));
  return {{"task", task},
          {"experts", validity.experts},
          {"novices", validity.novices},
          {"simulated", validity.simulated > 0},
          {"score", separated_json(validity.score)},
          {"metrics", std::move(metrics)},
          {"discriminating", discriminating_json(validity)},
          {"alpha", alpha_json(validity.alpha)},
          {"pass_mark", pass_mark_json(validity.pass_mark)}};
}

Result<HttpAnswer> show_validity(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string task, query_task(call.request));
  TROCAR_TRY(const std::string course, query_course(call.request));
  return cached(backend.statistics, backend.repositories, "validity\n" + task + "\n" + course, call.now, "task",
                [=, &backend](results::Repository& repository) -> Result<std::optional<Json>> {
                  results::EvidenceFilter filter;
                  filter.task = task;
                  filter.course = course;
                  TROCAR_TRY(const cohort::Validity validity, results::validity_of(repository, filter));
                  return std::optional<Json>(validity_json(task, validity));
                });
}

}  // namespace

std::vector<Route> metric_routes() {
  return {
      {"GET", "/api/metrics", Access::kInstructor, list_metrics},
      {"GET", "/api/metrics/*", Access::kInstructor, show_distribution},
      {"GET", "/api/validity", Access::kInstructor, show_validity},
  };
}

}  // namespace trocar::web
