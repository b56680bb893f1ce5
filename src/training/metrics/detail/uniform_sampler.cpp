#include "metrics/detail/uniform_sampler.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace trocar::metrics::detail {
namespace {

constexpr double kHighest_hz = 10.0;
constexpr double kThreshold = 0.05;
constexpr std::size_t kPadding = 16;  // finer steps of the frequency

/// Fourier transform in place, of a power of two of values (Cooley, Tukey 1965).
void transform(std::vector<std::complex<double>>& x) {
  const std::size_t count = x.size();
  for (std::size_t i = 1, j = 0; i < count; ++i) {
    std::size_t bit = count >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  std::vector<std::complex<double>> turn(count / 2);
  for (std::size_t k = 0; k < turn.size(); ++k)
    turn[k] = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count));
  for (std::size_t half = 1; half < count; half *= 2) {
    const std::size_t stride = count / (2 * half);
    for (std::size_t begin = 0; begin < count; begin += 2 * half)
      for (std::size_t k = 0; k < half; ++k) {
        const std::complex<double> odd = turn[k * stride] * x[begin + half + k];
        x[begin + half + k] = x[begin + k] - odd;
        x[begin + k] += odd;
      }
  }
}

}  // namespace

std::optional<double> spectral_arc_length(const std::vector<double>& speed, double period_s) {
  std::size_t count = 1;
  while (count < speed.size()) count *= 2;
  count *= kPadding;
  std::vector<std::complex<double>> spectrum(count);
  for (std::size_t n = 0; n < speed.size(); ++n) spectrum[n] = speed[n];
  transform(spectrum);
  const double zero = std::abs(spectrum[0]);
  if (!(zero > 0.0)) return std::nullopt;
  const double step_hz = 1.0 / (period_s * static_cast<double>(count));
  const auto in_band = std::min(static_cast<std::size_t>(kHighest_hz / step_hz), count / 2);
  std::size_t last = 0;
  for (std::size_t k = 0; k <= in_band; ++k)
    if (std::abs(spectrum[k]) >= kThreshold * zero) last = k;
  if (last == 0) return std::nullopt;
  double length = 0.0;
  for (std::size_t k = 1; k <= last; ++k)
    length += std::hypot(1.0 / static_cast<double>(last), (std::abs(spectrum[k]) - std::abs(spectrum[k - 1])) / zero);
  return -length;
}

}  // namespace trocar::metrics::detail
