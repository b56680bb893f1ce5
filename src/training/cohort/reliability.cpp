#include "cohort/reliability.h"

#include <fmt/format.h>

#include "cohort/detail/distributions.h"

namespace trocar::cohort {
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
