#include "haptics/insertion/insertion_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::haptics {

double prepuncture_force_n(double x_mm, double v_mm_per_s, const LoadingLaw& law) noexcept {
  if (!(x_mm > 0.0)) return 0.0;
  const double k = law.stiffness_n_per_mm;
  const double dx = law.delta_x_mm;
  const double bracket =
      6.0 * law.viscosity_ns_per_mm * v_mm_per_s * dx + k * x_mm * x_mm + 3.0 * k * x_mm * dx + 2.0 * k * dx * dx;
  return std::max(0.0, x_mm * bracket / (6.0 * dx * dx));
}

double static_displacement_mm(double force_n, const LoadingLaw& law) noexcept {
  if (!(force_n > 0.0)) return 0.0;
  double low = 0.0;
  double high = law.delta_x_mm;
  while (prepuncture_force_n(high, 0.0, law) < force_n && high < 1e6) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (prepuncture_force_n(middle, 0.0, law) < force_n ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double tangent_stiffness_n_per_mm(double x_mm, const LoadingLaw& law) noexcept {
  const double x = std::max(0.0, x_mm);
  const double dx = law.delta_x_mm;
  return law.stiffness_n_per_mm * (3.0 * x * x + 6.0 * x * dx + 2.0 * dx * dx) / (6.0 * dx * dx);
}

double contact_area_cm2(double radius_mm, double inserted_mm) noexcept {
  constexpr double kMm2PerCm2 = 100.0;
  return 2.0 * std::numbers::pi * radius_mm * std::max(0.0, inserted_mm) / kMm2PerCm2;
}

double friction_noise(std::uint64_t seed, std::uint32_t tissue, double travel_mm) noexcept {
  const double position = travel_mm / kNoiseCorrelation_mm;
  const double node = std::floor(position);
  const double t = position - node;
  const auto index = static_cast<std::uint64_t>(static_cast<std::int64_t>(node));
  const std::uint64_t stream = mix64(seed ^ (static_cast<std::uint64_t>(tissue) << 32));
  const double a = 2.0 * uniform01(stream, index) - 1.0;
  const double b = 2.0 * uniform01(stream, index + 1) - 1.0;
  return a + (b - a) * t * t * (3.0 - 2.0 * t);
}

}  // namespace trocar::haptics
