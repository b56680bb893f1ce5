#include "cohort/learning_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cohort/detail/distributions.h"
#include "core/result.h"

namespace trocar::cohort {
namespace {

bool has_score(const std::optional<double>& score) {
  return score && std::isfinite(*score);
}

Status check_rate(double rate, double low, double high, const char* name) {
  if (rate >= low && rate <= high) return {};  // false for NaN
  return fail_usage(fmt::format("{} of {:g} is not within {:g} and {:g}", name, rate, low, high), "CUSUM",
                    "choose another one");
}

Status check_rates(const CusumRates& rates) {
  TROCAR_TRY_STATUS(check_rate(rates.acceptable, 0.001, 0.9, "an acceptable failure rate"));
  TROCAR_TRY_STATUS(check_rate(rates.unacceptable, 0.001, 0.999, "an unacceptable failure rate"));
  TROCAR_TRY_STATUS(check_rate(rates.alpha, 0.001, 0.499, "alpha"));
  TROCAR_TRY_STATUS(check_rate(rates.beta, 0.001, 0.499, "beta"));
  if (rates.unacceptable > rates.acceptable) return {};
  return fail_usage(fmt::format("the unacceptable failure rate {:g} is not above the acceptable {:g}",
                                rates.unacceptable, rates.acceptable),
                    "CUSUM", "exchange them");
}

}  // namespace

std::vector<std::optional<double>> moving_mean(std::span<const std::optional<double>> scores, std::size_t window) {
  TROCAR_CHECK(window >= 1);
  std::vector<std::optional<double>> means;
  std::vector<double> last;
  for (const std::optional<double>& score : scores) {
    if (has_score(score)) last.push_back(*score);
    if (last.size() > window) last.erase(last.begin());
    means.push_back(last.empty() ? std::nullopt : std::optional(mean_of(last)));
  }
  return means;
}

std::optional<double> trend_per_attempt(std::span<const std::optional<double>> scores) {
  constexpr std::ptrdiff_t kLeastScores = 3;
  if (std::count_if(scores.begin(), scores.end(), has_score) < kLeastScores) return std::nullopt;
  std::vector<double> slopes;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b)
      if (has_score(scores[a]) && has_score(scores[b]))
        slopes.push_back((*scores[b] - *scores[a]) / static_cast<double>(b - a));
  return quantile_of(slopes, 0.5);
}

Result<Cusum> cusum_of(const std::vector<bool>& passed, const CusumRates& rates) {
  TROCAR_TRY_STATUS(check_rates(rates));
  const double p = std::log(rates.unacceptable / rates.acceptable);
  const double q = std::log((1.0 - rates.acceptable) / (1.0 - rates.unacceptable));
  Cusum cusum;
  cusum.pass_step = q / (p + q);
  cusum.lower = -std::log((1.0 - rates.alpha) / rates.beta) / (p + q);
  cusum.upper = std::log((1.0 - rates.beta) / rates.alpha) / (p + q);
  double sum = 0.0;
  for (const bool is_passed : passed) {
    sum += is_passed ? -cusum.pass_step : 1.0 - cusum.pass_step;
    cusum.values.push_back(sum);
    if (sum > cusum.lower && sum < cusum.upper) continue;
    cusum.signals.push_back(
        {cusum.values.size(), sum <= cusum.lower ? Cusum::Decision::kAcceptable : Cusum::Decision::kUnacceptable});
    sum = 0.0;
  }
  return cusum;
}

std::vector<std::optional<CurvePoint>> mean_curve(std::span<const std::vector<std::optional<double>>> people) {
  std::vector<std::vector<double>> by_attempt;
  for (const std::vector<std::optional<double>>& scores : people)
    for (std::size_t n = 0; n < scores.size(); ++n) {
      if (!has_score(scores[n])) continue;
      by_attempt.resize(std::max(by_attempt.size(), n + 1));
      by_attempt[n].push_back(*scores[n]);
    }
  std::vector<std::optional<CurvePoint>> curve;
  for (const std::vector<double>& scores : by_attempt) {
    curve.emplace_back();
    if (scores.empty()) continue;
    CurvePoint& point = curve.back().emplace(CurvePoint{scores.size(), mean_of(scores)});
    if (scores.size() < 2) continue;
    const auto n = static_cast<double>(scores.size());
    const double student_t = std::sqrt(f_quantile(0.95, 1.0, n - 1.0));  // two-sided 95 %: t² has the F distribution
    const double half = student_t * standard_deviation_of(scores) / std::sqrt(n);
    point.interval = Interval{point.mean - half, point.mean + half};
  }
  return curve;
}

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

Status check_finite(std::span<const double> values, std::string_view what) {
  const auto bad = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
  if (bad == values.end()) return {};
  return fail(fmt::format("value {} is not a number", bad - values.begin() + 1), std::string(what),
              "leave out attempts without a value");
}

double mean_of(std::span<const double> values) {
  TROCAR_CHECK(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation_of(std::span<const double> values) {
  TROCAR_CHECK(values.size() >= 2);
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

std::optional<double> quantile_of(std::span<const double> values, double share) {
  TROCAR_CHECK(share >= 0.0 && share <= 1.0);
  if (values.empty()) return std::nullopt;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

std::optional<Quartiles> quartiles_of(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  const auto at = [&](double share) { return *quantile_of(values, share); };
  return Quartiles{at(0.0), at(0.25), at(0.5), at(0.75), at(1.0)};
}

std::optional<double> person_mean(std::span<const std::optional<double>> by_attempt, const AttemptRange& range) {
  std::vector<double> values;
  for (std::size_t n = 0; n < by_attempt.size(); ++n) {
    const bool is_within = n + 1 >= range.first && n + 1 <= range.last;
    if (is_within && by_attempt[n] && std::isfinite(*by_attempt[n])) values.push_back(*by_attempt[n]);
  }
  if (values.empty()) return std::nullopt;
  return mean_of(values);
}

}  // namespace trocar::cohort
