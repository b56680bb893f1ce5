#include "slices/slice_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace trocar::slices {

SliceAxes slice_axes(SliceOrientation orientation) noexcept {
  switch (orientation) {
    case SliceOrientation::kAxial:
      return {Vec3::UnitX(), Vec3::UnitY()};
    case SliceOrientation::kCoronal:
      return {Vec3::UnitX(), -Vec3::UnitZ()};
    case SliceOrientation::kSagittal:
      break;
  }
  return {Vec3::UnitY(), -Vec3::UnitZ()};
}

SliceAxes needle_axes(const Vec3& axis_P, NeedlePlane plane) noexcept {
  // Closer to the long axis of the body, the axial direction is undefined; the front is used instead.
  constexpr double kAlongBody = 0.98;
  const Vec3 up_P = std::abs(axis_P.z()) < kAlongBody ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitY());
  const Vec3 head_P = (up_P - up_P.dot(axis_P) * axis_P).normalized();
  const Vec3 side_P = axis_P.cross(head_P);
  switch (plane) {
    case NeedlePlane::kAlong:
      return {side_P, axis_P};
    case NeedlePlane::kAlongTurned:
      return {-head_P, axis_P};
    case NeedlePlane::kAcross:
      break;
  }
  return {side_P, -head_P};
}

namespace {

/// Pixel coordinates of the picture's centre.
Eigen::Vector2d middle_px(const SliceGeometry& geometry) {
  return {0.5 * (geometry.columns - 1), 0.5 * (geometry.rows - 1)};
}

}  // namespace

Eigen::Vector2d SliceGeometry::to_pixel(const Vec3& p_P) const noexcept {
  const Vec3 from_center_P = p_P - center_P;
  return middle_px(*this) + Eigen::Vector2d(axes.u_P.dot(from_center_P), axes.v_P.dot(from_center_P)) / mm_per_px;
}

Vec3 SliceGeometry::to_P(const Eigen::Vector2d& pixel) const noexcept {
  const Eigen::Vector2d from_center_mm = mm_per_px * (pixel - middle_px(*this));
  return center_P + from_center_mm.x() * axes.u_P + from_center_mm.y() * axes.v_P;
}

volume::SlicePlane SliceGeometry::plane() const noexcept {
  volume::SlicePlane plane;
  plane.origin_P = to_P({0.0, 0.0});
  plane.step_u_P = mm_per_px * axes.u_P;
  plane.step_v_P = mm_per_px * axes.v_P;
  plane.columns = columns;
  plane.rows = rows;
  return plane;
}

void SliceGeometry::zoom_at(const Eigen::Vector2d& pixel, double new_mm_per_px) noexcept {
  const Vec3 fixed_P = to_P(pixel);
  mm_per_px = new_mm_per_px;
  center_P += fixed_P - to_P(pixel);
}

Box volume_box(const volume::GridGeometry& geometry) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a & 1) != 0 ? static_cast<double>(geometry.size[static_cast<std::size_t>(a)]) - 0.5 : -0.5;
    box.extend(geometry.to_mm(index));
  }
  return box;
}

Box body_box(const anatomy::VirtualPatient& patient) {
  constexpr std::int64_t kStride = 4;
  Box box;
  const volume::FloatGrid& distance = patient.skin_distance_mm;
  const volume::GridGeometry& geometry = distance.geometry;
  for (std::int64_t k = 0; k < geometry.size[2]; k += kStride)
    for (std::int64_t j = 0; j < geometry.size[1]; j += kStride)
      for (std::int64_t i = 0; i < geometry.size[0]; i += kStride)
        if (distance[{i, j, k}] < 0.0F)
          box.extend(geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
  if (!box.isEmpty()) {
    const Vec3 skipped_mm = static_cast<double>(kStride) * geometry.spacing_mm;  // the grid may be rotated against P
    const double margin_mm = skipped_mm.maxCoeff();
    return {box.min() - Vec3::Constant(margin_mm), box.max() + Vec3::Constant(margin_mm)};
  }
  return volume_box(patient.ct.geometry);
}

double fitting_scale(const Box& box, const SliceAxes& axes, int columns, int rows) noexcept {
  const Vec3 sides_mm = box.sizes();
  const double width_mm = axes.u_P.cwiseAbs().dot(sides_mm);
  const double height_mm = axes.v_P.cwiseAbs().dot(sides_mm);
  return std::max(width_mm / std::max(columns, 1), height_mm / std::max(rows, 1));
}

std::string direction_letters(const Vec3& direction_P) {
  constexpr double kLean = 0.342;  // sine of 20 degrees
  const double length = direction_P.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return {};
  constexpr std::array<std::pair<char, char>, 3> kLetters{{{'L', 'R'}, {'P', 'A'}, {'H', 'F'}}};
  std::array<std::size_t, 3> order{0, 1, 2};
  const auto share = [&](std::size_t a) { return std::abs(direction_P[static_cast<int>(a)]) / length; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
  std::string letters;
  for (const std::size_t a : order)
    if (letters.empty() || share(a) > kLean)
      letters += direction_P[static_cast<int>(a)] > 0.0 ? kLetters[a].first : kLetters[a].second;
  return letters;
}

}  // namespace trocar::slices
