#include "ultrasound/measurements.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

namespace trocar {

void Measurements::add(const Measurement& measurement) {
  std::vector<Measurement> changed = items();
  changed.push_back(measurement);
  history_.step_to(std::move(changed));
}

void Measurements::remove_last() {
  if (items().empty()) return;
  std::vector<Measurement> changed = items();
  changed.pop_back();
  history_.step_to(std::move(changed));
}

void Measurements::clear() {
  if (!items().empty()) history_.step_to({});
}

std::vector<std::string> results(const Measurement& measurement) {
  if (const auto* distance = std::get_if<DistanceCaliper>(&measurement))
    return {fmt::format("Dist {:.1f} mm", distance->distance_mm())};
  if (const auto* ellipse = std::get_if<EllipseCaliper>(&measurement)) {
    constexpr double kCm2_per_mm2 = 0.01;
    return {fmt::format("Ell {:.1f} x {:.1f} mm", ellipse->length_mm(), ellipse->width_mm()),
            fmt::format("Area {:.2f} cm²", kCm2_per_mm2 * ellipse->area_mm2()),
            fmt::format("Circ {:.1f} mm", ellipse->circumference_mm())};
  }
  constexpr double kDeg_per_rad = 180.0 / std::numbers::pi;
  return {fmt::format("Angle {:.1f}°", kDeg_per_rad * std::get<AngleCaliper>(measurement).angle_rad())};
}

}  // namespace trocar
