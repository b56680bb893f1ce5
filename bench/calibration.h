#pragma once

#include <chrono>

namespace trocar::bench {

/// Time of one call, in microseconds.
template <class Work>
double time_us(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// A chain of dependent multiplications and additions that the compiler cannot shorten: about 8 us, the same on every
/// call, whatever its argument. Interleaved with a tick, its time measures the speed of the machine at that moment.
[[gnu::noipa]] inline double calibration_arithmetic(double x) noexcept {
  constexpr int kSteps = 5000;
  for (int i = 0; i < kSteps; ++i) x = x * 0.999 + 0.001;
  return x;
}

}  // namespace trocar::bench
