#pragma once

namespace trocar::cohort {

/// Standard normal distribution: probability of a value below z.
double normal_below(double z) noexcept;
/// Inverse of normal_below. `probability` 1e-12 .. 1 - 1e-12.
double normal_quantile(double probability) noexcept;

/// Regularised incomplete beta function I_x(a, b). a, b > 0, x 0..1. Relative error below 1e-10.
double incomplete_beta(double a, double b, double x) noexcept;
/// Quantile of the F distribution with d1 and d2 (> 0) degrees of freedom. `probability` in (0, 1).
double f_quantile(double probability, double d1, double d2) noexcept;

/// Root of a function that is negative (or 0) at `low` and positive (or 0) at `high`, to the last bit.
template <class Function>
double bisect(double low, double high, const Function& function) noexcept {
  constexpr int kHalvings = 200;  // more than a double has bits between any two numbers of one scale
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace trocar::cohort
