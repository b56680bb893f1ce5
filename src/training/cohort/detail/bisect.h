#pragma once

namespace trocar::cohort {

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
