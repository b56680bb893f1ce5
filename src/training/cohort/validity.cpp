#include "cohort/validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cohort/detail/distributions.h"
#include "core/result.h"

namespace trocar::cohort {
namespace {

using Values = std::vector<std::optional<double>>;

/// Values of one group; those that are missing or not finite are left out.
std::vector<double> of_group(const Values& values, const std::vector<CohortData::Person>& people, bool is_expert) {
  TROCAR_CHECK(values.size() == people.size());
  std::vector<double> chosen;
  for (std::size_t n = 0; n < people.size(); ++n)
    if (people[n].is_expert == is_expert && values[n] && std::isfinite(*values[n])) chosen.push_back(*values[n]);
  return chosen;
}

Result<Separation> separation_in(const CohortData& data, const Values& values, Better better) {
  const std::vector<double> experts = of_group(values, data.people, true);
  const std::vector<double> novices = of_group(values, data.people, false);
  if (experts.empty() || novices.empty())
    return fail(fmt::format("people with a value: experts {}, novices {}", experts.size(), novices.size()),
                "separation", "record attempts of both groups");
  return separation_of(experts, novices, better);
}

bool are_experts_better(const MetricValidity& metric) {
  return metric.better == Better::kNeither || metric.separation->auc > 0.5;
}

void decide(MetricValidity& metric, double corrected_p, double level) {
  metric.corrected_p = corrected_p;
  metric.discriminates = corrected_p <= level && are_experts_better(metric);
}

void decide_all(Validity& validity, const ValidityRules& rules) {
  std::vector<double> p;
  for (const MetricValidity& metric : validity.metrics)
    if (metric.separation) p.push_back(metric.separation->test.p);
  const std::vector<double> corrected = corrected_p(p, rules.correction);
  for (MetricValidity& metric : validity.metrics) {
    if (!metric.separation) continue;
    decide(metric, corrected[validity.tested++], rules.level);
    validity.discriminating += metric.discriminates ? 1 : 0;
    validity.uncorrected += metric.separation->test.p <= rules.level && are_experts_better(metric) ? 1 : 0;
  }
  for (MetricValidity* one : {&validity.score, &validity.passes})
    if (one->separation) decide(*one, one->separation->test.p, rules.level);
}

bool has_value(const std::optional<double>& item) {
  return item && std::isfinite(*item);
}

/// The items that all people with any item have. A part of the score that some attempts do not judge is left out, not
/// the people without it.
std::vector<std::vector<double>> common_items(const CohortData& data) {
  std::vector<const Values*> people;
  for (const Values& items : data.items)
    if (std::any_of(items.begin(), items.end(), has_value)) people.push_back(&items);
  std::vector<std::vector<double>> table(people.size());
  const std::size_t count = people.empty() ? 0 : people.front()->size();
  for (std::size_t item = 0; item < count; ++item) {
    if (!std::all_of(people.begin(), people.end(), [&](const Values* items) { return has_value((*items)[item]); }))
      continue;
    for (std::size_t n = 0; n < people.size(); ++n) table[n].push_back(*(*people[n])[item]);
  }
  return table;
}

}  // namespace

Validity validity_of(const CohortData& data, const ValidityRules& rules) {
  const auto count = [&](auto is_counted) {
    return static_cast<std::size_t>(std::count_if(data.people.begin(), data.people.end(), is_counted));
  };
  Values pass_shares = data.pass_shares;
  pass_shares.resize(data.people.size());
  Validity validity{
      count([](const CohortData::Person& person) { return person.is_expert; }),
      count([](const CohortData::Person& person) { return !person.is_expert; }),
      count([](const CohortData::Person& person) { return person.is_simulated; }),
      0,
      0,
      0,
      0,
      {"score", "Score", "points", Better::kHigher, separation_in(data, data.scores, Better::kHigher)},
      {"pass_share", "Share of attempts passed", "1", Better::kHigher,
       separation_in(data, pass_shares, Better::kHigher)},
      {},
      0,
      0,
      0,
      cronbach_alpha(common_items(data)),
      contrasting_groups(of_group(data.scores, data.people, true), of_group(data.scores, data.people, false))};
  for (const CohortData::Person& person : data.people) {
    (person.is_expert ? validity.expert_attempts : validity.novice_attempts) += person.attempts;
    (person.is_expert ? validity.expert_unscored : validity.novice_unscored) += person.unscored;
  }
  for (const MetricOfPeople& metric : data.metrics)
    validity.metrics.push_back(
        {metric.name, metric.title, metric.unit, metric.better, separation_in(data, metric.values, metric.better)});
  decide_all(validity, rules);
  return validity;
}

std::string smallest_p_text(std::size_t experts, std::size_t novices, std::size_t metrics, double level) {
  if (experts == 0 || novices == 0) return {};
  const double smallest = smallest_rank_sum_p(experts, novices);
  if (smallest * static_cast<double>(std::max<std::size_t>(metrics, 1)) <= level) return {};
  return fmt::format("with groups of {} and {} people whose values all differ no two-sided p can be below {:.2g}",
                     experts, novices, smallest);
}

namespace {

constexpr const char* kConsistency = "internal consistency";

Status check_items(std::span<const std::vector<double>> people) {
  if (people.size() < 2)
    return fail(fmt::format("it takes at least 2 people, not {}", people.size()), kConsistency,
                "record attempts of more people");
  const std::size_t items = people.front().size();
  if (items < 2)
    return fail(fmt::format("it takes at least 2 items, not {}", items), kConsistency, "choose more items");
  for (std::size_t n = 0; n < people.size(); ++n) {
    TROCAR_TRY_STATUS(check_finite(people[n], fmt::format("items of person {}", n + 1)));
    if (people[n].size() != items)
      return fail(fmt::format("person {} has {} items, the first one {}", n + 1, people[n].size(), items), kConsistency,
                  "leave out people without all items");
  }
  return {};
}

double variance_of(std::span<const double> values) {
  const double deviation = standard_deviation_of(values);
  return deviation * deviation;
}

}  // namespace

Result<Alpha> cronbach_alpha(std::span<const std::vector<double>> people) {
  TROCAR_TRY_STATUS(check_items(people));
  const std::size_t items = people.front().size();
  std::vector<double> totals(people.size(), 0.0), column(people.size());
  double item_variances = 0.0;
  for (std::size_t item = 0; item < items; ++item) {
    for (std::size_t n = 0; n < people.size(); ++n) {
      column[n] = people[n][item];
      totals[n] += column[n];
    }
    item_variances += variance_of(column);
  }
  const double total_variance = variance_of(totals);
  constexpr double kRounding = 1e-18;  // of the squares of the totals
  if (total_variance <= kRounding * (1.0 + totals.front() * totals.front()))
    return fail("all people have the same total score", kConsistency, "record people of different skill");
  Alpha alpha;
  alpha.items = items;
  alpha.people = people.size();
  const auto k = static_cast<double>(items);
  alpha.value = k / (k - 1.0) * (1.0 - item_variances / total_variance);
  const double d1 = static_cast<double>(people.size() - 1), d2 = d1 * (k - 1.0);
  alpha.interval = {1.0 - (1.0 - alpha.value) * f_quantile(0.975, d1, d2),
                    1.0 - (1.0 - alpha.value) * f_quantile(0.025, d1, d2)};
  return alpha;
}

}  // namespace trocar::cohort
