#include "cohort/detail/distributions.h"

#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace trocar::cohort {
namespace {

/// The continued fraction of I_x(a, b), evaluated from the front by Lentz's method (Abramowitz and Stegun 26.5.8).
double beta_fraction(double a, double b, double x) noexcept {
  constexpr int kMostTerms = 10000;
  constexpr double kTiny = 1e-300;
  constexpr double kPrecision = 1e-15;
  const auto not_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double numerator = 1.0, denominator = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0)), result = denominator;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    double change = 1.0;
    for (const double term : {even, odd}) {
      denominator = 1.0 / not_zero(1.0 + term * denominator);
      numerator = not_zero(1.0 + term / numerator);
      change = numerator * denominator;
      result *= change;
    }
    if (std::abs(change - 1.0) < kPrecision) break;
  }
  return result;
}

}  // namespace

double normal_below(double z) noexcept {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double normal_quantile(double probability) noexcept {
  constexpr double kFar = 8.0;
  return bisect(-kFar, kFar, [&](double z) { return normal_below(z) - probability; });
}

double incomplete_beta(double a, double b, double x) noexcept {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  // The fraction converges fast on the side of the mean; the other side by symmetry.
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
  const double log_front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x) - std::log(a);
  return std::exp(log_front) * beta_fraction(a, b, x);
}

double f_quantile(double probability, double d1, double d2) noexcept {
  const double x =
      bisect(0.0, 1.0, [&](double trial) { return incomplete_beta(0.5 * d1, 0.5 * d2, trial) - probability; });
  return x < 1.0 ? d2 * x / (d1 * (1.0 - x)) : std::numeric_limits<double>::infinity();
}

}  // namespace trocar::cohort
