#include "registration/shadow/beams.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <vector>

#include "core/text.h"

namespace trocar::registration {
namespace {

struct Axis {
  int index = 1;
  double sign = 1.0;
};

std::optional<Axis> parse_axis(std::string_view text) {
  if (text.size() != 2 || (text[0] != '+' && text[0] != '-') || text[1] < 'x' || text[1] > 'z') return std::nullopt;
  return Axis{text[1] - 'x', text[0] == '+' ? 1.0 : -1.0};
}

/// Columns: lateral, beam, elevation; right-handed.
Mat3 beam_axes(const Mat3& R_PV, const Axis& axis) {
  const Vec3 beam = axis.sign * R_PV.col(axis.index);
  const Vec3 lateral = R_PV.col(axis.index == 0 ? 1 : 0);
  Mat3 R;
  R << lateral, beam, lateral.cross(beam);
  return R;
}

Result<std::vector<double>> numbers(const HeaderFields& fields, const std::string& key, std::size_t count) {
  const auto found = fields.find(key);
  if (found == fields.end())
    return fail(fmt::format("the header of the fan has no {}", key), {}, "give a beam axis, or complete the header");
  std::istringstream stream(found->second);
  std::vector<double> values;
  for (std::string word; stream >> word;) {
    const auto value = parse_number<double>(word);
    if (!value || !std::isfinite(*value))
      return fail(fmt::format("{} is not a number", key), found->second, "correct the header, or give a beam axis");
    values.push_back(*value);
  }
  if (values.size() != count)
    return fail(fmt::format("{} has {} numbers, not {}", key, values.size(), count), found->second,
                "correct the header, or give a beam axis");
  return values;
}

Result<double> number_between(const HeaderFields& fields, const std::string& key, double low, double high) {
  TROCAR_TRY(const std::vector<double> value, numbers(fields, key, 1));
  if (value[0] < low || value[0] > high)
    return fail(fmt::format("{} is not within {:g}..{:g}", key, low, high), fmt::format("{:g}", value[0]),
                "correct the header, or give a beam axis");
  return value[0];
}

}  // namespace

Result<Beams> Beams::along_axis(std::string_view text, const volume::GridGeometry& geometry) {
  const std::optional<Axis> axis = parse_axis(text);
  if (!axis)
    return fail_usage("the beam axis is not a direction along an axis of the volume", std::string(text),
                      "give +x, -x, +y, -y, +z or -z");
  Beams beams;
  beams.R_PB_ = beam_axes(geometry.R_PV, *axis);
  const Vec3 last(static_cast<double>(geometry.size[0] - 1), static_cast<double>(geometry.size[1] - 1),
                  static_cast<double>(geometry.size[2] - 1));
  const Vec3 ends[2] = {beams.R_PB_.transpose() * geometry.to_mm(Vec3::Zero()),
                        beams.R_PB_.transpose() * geometry.to_mm(last)};
  const Vec3 low = ends[0].cwiseMin(ends[1]);
  beams.p_PB_ = beams.R_PB_ * low;
  beams.extent_mm_ = ends[0].cwiseMax(ends[1]) - low;
  beams.depth_mm_ = beams.extent_mm_.y();
  return beams;
}

Result<Beams> Beams::choose(std::string_view axis, const HeaderFields& fields, const volume::GridGeometry& geometry) {
  return axis.empty() ? from_header(fields, geometry) : along_axis(axis, geometry);
}

Result<Beams> Beams::from_header(const HeaderFields& fields, const volume::GridGeometry& geometry) {
  const auto axis_text = fields.find("trocar_beam_axis");
  const std::string axis_name = axis_text == fields.end() ? "+y" : axis_text->second;
  if (!fields.contains("trocar_apex_mm")) return along_axis(axis_name, geometry);
  const std::optional<Axis> axis = parse_axis(axis_name);
  if (!axis)
    return fail("trocar_beam_axis is not a direction along an axis of the volume", axis_name,
                "correct the header, or give a beam axis");
  Beams beams;
  beams.is_fan_ = true;
  beams.R_PB_ = beam_axes(geometry.R_PV, *axis);
  TROCAR_TRY(const std::vector<double> apex, numbers(fields, "trocar_apex_mm", 3));
  TROCAR_TRY(beams.radius_mm_, number_between(fields, "trocar_radius_mm", 0.0, 1000.0));
  TROCAR_TRY(beams.depth_mm_, number_between(fields, "trocar_depth_mm", 1.0, 1000.0));
  TROCAR_TRY(const double view_rad, number_between(fields, "trocar_fov_rad", 0.01, std::numbers::pi));
  beams.half_view_rad_ = 0.5 * view_rad;
  beams.sweep_radius_mm_ = beams.radius_mm_;
  beams.half_sweep_rad_ = beams.half_view_rad_;
  if (fields.contains("trocar_sweep_rad")) {
    TROCAR_TRY(const double sweep_rad, number_between(fields, "trocar_sweep_rad", 0.001, std::numbers::pi));
    TROCAR_TRY(beams.sweep_radius_mm_, number_between(fields, "trocar_sweep_radius_mm", 0.0, 1000.0));
    beams.half_sweep_rad_ = 0.5 * sweep_rad;
  }
  beams.p_PB_ = Vec3(apex[0], apex[1], apex[2]) + beams.R_PB_ * Vec3(0.0, beams.radius_mm_, 0.0);
  return beams;
}

Beams::Place Beams::to_place(const Vec3& p) const noexcept {
  const Vec3 b = R_PB_.transpose() * (p - p_PB_);
  if (!is_fan_) return {b.x(), b.z(), b.y()};
  const double above_axis = b.y() + sweep_radius_mm_;
  const double in_plane = std::hypot(above_axis, b.z()) - sweep_radius_mm_ + radius_mm_;
  return {std::atan2(b.x(), in_plane), std::atan2(b.z(), above_axis), std::hypot(b.x(), in_plane) - radius_mm_};
}

Vec3 Beams::to_point(const Place& place) const noexcept {
  if (!is_fan_) return p_PB_ + R_PB_ * Vec3(place.lateral, place.depth_mm, place.elevation);
  const double r = place.depth_mm + radius_mm_;
  const double above_axis = r * std::cos(place.lateral) - radius_mm_ + sweep_radius_mm_;
  return p_PB_ + R_PB_ * Vec3(r * std::sin(place.lateral), above_axis * std::cos(place.elevation) - sweep_radius_mm_,
                              above_axis * std::sin(place.elevation));
}

Vec3 Beams::direction(const Vec3& p) const noexcept {
  if (!is_fan_) return R_PB_.col(1);
  const Place at = to_place(p);
  const double along = std::cos(at.lateral);
  return R_PB_ * Vec3(std::sin(at.lateral), along * std::cos(at.elevation), along * std::sin(at.elevation));
}

bool Beams::is_inside(const Place& place) const noexcept {
  return distance_to_edge_mm(place) >= -1e-6;
}

double Beams::distance_to_edge_mm(const Place& place) const noexcept {
  if (!is_fan_) {
    const double sides =
        std::min({place.lateral, extent_mm_.x() - place.lateral, place.elevation, extent_mm_.z() - place.elevation});
    return std::min({sides, place.depth_mm, extent_mm_.y() - place.depth_mm});
  }
  const double r = place.depth_mm + radius_mm_;
  const double swing = r * std::cos(place.lateral) - radius_mm_ + sweep_radius_mm_;
  return std::min({r * (half_view_rad_ - std::abs(place.lateral)),
                   swing * (half_sweep_rad_ - std::abs(place.elevation)), place.depth_mm, depth_mm_ - place.depth_mm});
}

}  // namespace trocar::registration
