#include "ultrasound/scanner/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
  return {fmt::format("Angle {:.1f}°", kDegPerRad * std::get<AngleCaliper>(measurement).angle_rad())};
}

namespace {

constexpr int kMeanSteps = 8;  ///< Each step of the mean doubles the digits; five suffice.

double cross(const Vec2& a, const Vec2& b) noexcept {
  return a.x() * b.y() - a.y() * b.x();
}

Vec2 place(const RasterGeometry& raster, const Vec2& pixel) noexcept {
  return raster.to_T(pixel.x(), pixel.y());
}

}  // namespace

DistanceCaliper place_distance(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel) noexcept {
  return {place(raster, a_pixel), place(raster, b_pixel)};
}

EllipseCaliper place_ellipse(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel,
                             const Vec2& side_pixel) noexcept {
  EllipseCaliper caliper{place(raster, a_pixel), place(raster, b_pixel), 0.0};
  caliper.half_width_mm = caliper.distance_to_axis_mm(place(raster, side_pixel));
  return caliper;
}

double EllipseCaliper::distance_to_axis_mm(const Vec2& p_T) const noexcept {
  const Vec2 axis = b_T - a_T;
  const double length_mm = axis.norm();
  return length_mm > 0.0 ? std::abs(cross(axis, p_T - a_T)) / length_mm : 0.0;
}

double EllipseCaliper::area_mm2() const noexcept {
  return std::numbers::pi * 0.5 * length_mm() * half_width_mm;
}

double EllipseCaliper::circumference_mm() const noexcept {
  double a = std::max(0.5 * length_mm(), half_width_mm);
  double b = std::min(0.5 * length_mm(), half_width_mm);
  if (b <= 0.0) return 4.0 * a;  // both ways
  // 2 pi / M(a, b) * (a^2 - sum of 2^(n-1) c_n^2), with c_0^2 = a^2 - b^2 and c_n = (a - b) / 2 of the step before
  // (Abramowitz and Stegun 17.6).
  double sum = a * a - 0.5 * (a * a - b * b);
  double power = 0.5;
  for (int i = 0; i < kMeanSteps; ++i) {
    const double c = 0.5 * (a - b);
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    power *= 2.0;
    sum -= power * c * c;
  }
  return 2.0 * std::numbers::pi * sum / a;
}

std::vector<Vec2> EllipseCaliper::outline_T(int count) const {
  std::vector<Vec2> points;
  points.reserve(static_cast<std::size_t>(std::max(count, 0)));
  const Vec2 middle = 0.5 * (a_T + b_T);
  const Vec2 along = 0.5 * (b_T - a_T);
  const double length_mm = along.norm();
  const Vec2 across = length_mm > 0.0 ? Vec2(-along.y(), along.x()) * (half_width_mm / length_mm) : Vec2(0.0, 0.0);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    points.emplace_back(middle + std::cos(angle) * along + std::sin(angle) * across);
  }
  return points;
}

AngleCaliper place_angle(const RasterGeometry& raster, const Vec2& corner_pixel, const Vec2& a_pixel,
                         const Vec2& b_pixel) noexcept {
  return {place(raster, corner_pixel), place(raster, a_pixel), place(raster, b_pixel)};
}

double AngleCaliper::angle_rad() const noexcept {
  const Vec2 a = a_T - corner_T;
  const Vec2 b = b_T - corner_T;
  return std::atan2(std::abs(cross(a, b)), a.dot(b));
}

}  // namespace trocar::ultrasound
