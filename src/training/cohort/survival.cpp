#include "cohort/survival.h"

#include <algorithm>
#include <cmath>

namespace trocar::cohort {
namespace {

constexpr double kNormal95 = 1.959963984540054;

/// exp(ln S ± 1.96 √V); a share of 0 has no logarithm: its limits are not known.
Interval share_interval(double share, double greenwood) {
  if (!(share > 0.0)) return {0.0, 1.0};
  const double factor = std::exp(kNormal95 * std::sqrt(greenwood));
  return {share / factor, std::min(1.0, share * factor)};
}

std::optional<double> first_half(const std::vector<Survival::Step>& steps, double (*share_of)(const Survival::Step&)) {
  // A share of one half that rounding makes larger is one half.
  constexpr double kHalf = 0.5 + 1e-12;
  const auto found =
      std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return share_of(step) <= kHalf; });
  return found == steps.end() ? std::nullopt : std::optional(found->time);
}

}  // namespace

Result<Survival> survival_of(std::span<const FollowUp> people) {
  if (people.empty()) return fail("there is nobody", "time to an event", "record attempts first");
  for (const FollowUp& one : people)
    if (!(one.time >= 0.0 && std::isfinite(one.time)))
      return fail("a time is negative or no number", "time to an event", "leave the person out");
  std::vector<FollowUp> sorted(people.begin(), people.end());
  std::sort(sorted.begin(), sorted.end(), [](const FollowUp& a, const FollowUp& b) { return a.time < b.time; });
  Survival survival;
  survival.people = sorted.size();
  double share = 1.0, greenwood = 0.0;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t next = first, reached = 0;
    for (; next < sorted.size() && sorted[next].time == sorted[first].time; ++next)
      reached += sorted[next].is_reached ? 1 : 0;
    if (reached > 0) {
      const std::size_t at_risk = sorted.size() - first;
      const auto n = static_cast<double>(at_risk), d = static_cast<double>(reached);
      share *= (n - d) / n;
      greenwood += d / (n * (n - d));
      survival.reached += reached;
      survival.steps.push_back({sorted[first].time, at_risk, reached, share, share_interval(share, greenwood)});
    }
    first = next;
  }
  using Step = Survival::Step;
  survival.median = first_half(survival.steps, [](const Step& step) { return step.open_share; });
  survival.low = first_half(survival.steps, [](const Step& step) { return step.interval.low; });
  survival.high = first_half(survival.steps, [](const Step& step) { return step.interval.high; });
  return survival;
}

}  // namespace trocar::cohort
