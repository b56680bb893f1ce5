#include "ultrasound/scanner/measurements.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

namespace trocar::ultrasound {

void Measurements::add(const Measurement& measurement) {
  std::vector<Measurement> changed = items();
  changed.push_back(measurement);
  history_.step_to(std::move(changed));
}

void Measurements::put(std::size_t item, const Measurement& measurement, bool joins) {
  if (item >= items().size()) return;
  std::vector<Measurement> changed = items();
  changed[item] = measurement;
  history_.step_to(std::move(changed), joins);
}

void Measurements::remove(std::size_t item) {
  if (item >= items().size()) return;
  std::vector<Measurement> changed = items();
  changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(item));
  history_.step_to(std::move(changed));
}

void Measurements::clear() {
  if (!items().empty()) history_.step_to({});
}

std::vector<Vec2> marks_T(const Measurement& measurement) {
  if (const auto* distance = std::get_if<DistanceCaliper>(&measurement)) return {distance->a_T, distance->b_T};
  if (const auto* ellipse = std::get_if<EllipseCaliper>(&measurement))
    return {ellipse->a_T, ellipse->b_T, ellipse->outline_T(4)[1]};
  const auto& angle = std::get<AngleCaliper>(measurement);
  return {angle.corner_T, angle.a_T, angle.b_T};
}

Measurement with_mark(Measurement measurement, std::size_t mark, const Vec2& p_T) {
  if (auto* distance = std::get_if<DistanceCaliper>(&measurement)) {
    (mark == 0 ? distance->a_T : distance->b_T) = p_T;
  } else if (auto* ellipse = std::get_if<EllipseCaliper>(&measurement)) {
    if (mark == 0) ellipse->a_T = p_T;
    if (mark == 1) ellipse->b_T = p_T;
    if (mark == 2) ellipse->half_width_mm = ellipse->distance_to_axis_mm(p_T);
  } else {
    auto& angle = std::get<AngleCaliper>(measurement);
    (mark == 0 ? angle.corner_T : mark == 1 ? angle.a_T : angle.b_T) = p_T;
  }
  return measurement;
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

}  // namespace trocar::ultrasound
