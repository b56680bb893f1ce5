#include "slices/motion_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/patient_motion.h"
#include "slices/paint_slice.h"

namespace trocar::slices {
namespace {

using motion::PatientMotion;

volume::SlicePlane whole_plane(const volume::GridGeometry& grid, const Vec3& middle, int across, int pixels) {
  Eigen::AlignedBox3d box(grid.origin_P);
  for (unsigned corner = 1; corner < 8; ++corner) {
    Vec3 index;
    for (unsigned axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1U) != 0 ? static_cast<double>(grid.size[axis] - 1) : 0.0;
    box.extend(grid.to_mm(index));
  }
  const double step_mm = box.sizes()[across] / std::max(pixels - 1, 1);
  volume::SlicePlane plane;
  plane.step_u_P = step_mm * Vec3::Unit(across);
  plane.step_v_P = -step_mm * Vec3::UnitZ();
  plane.columns = pixels;
  plane.rows = std::max(1, static_cast<int>(box.sizes().z() / step_mm) + 1);
  plane.origin_P = middle;
  plane.origin_P[across] = box.min()[across];
  plane.origin_P.z() = box.max().z();
  return plane;
}

void put(image::RgbImage& picture, int x, int y, const image::Rgb& colour) {
  if (x >= 0 && y >= 0 && x < picture.columns && y < picture.rows) picture.at(x, y) = colour;
}

void draw_line(image::RgbImage& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const image::Rgb& colour) {
  const int steps = std::max(1, static_cast<int>((b - a).cwiseAbs().maxCoeff() * 2.0));
  for (int n = 0; n <= steps; ++n) {
    const Eigen::Vector2d p = a + (b - a) * n / steps;
    put(picture, static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())), colour);
  }
}

/// Dark blue, green, yellow, red.
image::Rgb colour_of(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{20, 24, 60}, {30, 90, 150}, {40, 160, 90}, {230, 200, 60}, {210, 50, 40}}};
  const auto low = std::min(static_cast<std::size_t>(t * 4.0), std::size_t{3});
  image::Rgb colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(kStops[low][c] +
                                          (t * 4.0 - static_cast<double>(low)) * (kStops[low + 1][c] - kStops[low][c]));
  return colour;
}

/// Where the tissue that is at the plane's points now came from, and went to.
void paint_field(const anatomy::VirtualPatient& patient, const PatientMotion& from, const PatientMotion& to,
                 const volume::SlicePlane& plane, double most_mm, image::RgbImage& picture) {
  constexpr int kArrowEvery = 22;
  constexpr double kArrowLength = 1.5;
  constexpr image::Rgb kBlack{0, 0, 0}, kWhite{255, 255, 255};
  picture = image::RgbImage(plane.columns, plane.rows);
  const auto place = [&](int u, int v) -> Vec3 { return plane.origin_P + u * plane.step_u_P + v * plane.step_v_P; };
  const auto moved_mm = [&](int u, int v, Vec3& moved) {
    const Vec3 p_A = from.to_rest(place(u, v));
    if (volume::sample_linear(patient.skin_distance_mm, p_A) > 0.0) return false;
    moved = to.to_now(p_A) - from.to_now(p_A);
    return true;
  };
  Vec3 moved;
  for (int v = 0; v < plane.rows; ++v)
    for (int u = 0; u < plane.columns; ++u)
      put(picture, u, v, moved_mm(u, v, moved) ? colour_of(moved.norm() / most_mm) : kBlack);
  for (int v = kArrowEvery / 2; v < plane.rows; v += kArrowEvery)
    for (int u = kArrowEvery / 2; u < plane.columns; u += kArrowEvery) {
      if (!moved_mm(u, v, moved)) continue;
      const Eigen::Vector2d along = kArrowLength *
                                    Eigen::Vector2d(moved.dot(plane.step_u_P), moved.dot(plane.step_v_P)) /
                                    plane.step_u_P.squaredNorm();
      const Eigen::Vector2d start(u, v), end = start + along;
      if (along.norm() < 1.0) continue;
      draw_line(picture, start, end, kWhite);
      const Eigen::Vector2d back = -0.35 * along, side(-back.y(), back.x());
      draw_line(picture, end, end + back + 0.5 * side, kWhite);
      draw_line(picture, end, end + back - 0.5 * side, kWhite);
    }
}

void paste(const image::RgbImage& panel, int x, int y, image::RgbImage& sheet) {
  for (int row = 0; row < panel.rows; ++row) std::copy_n(&panel.at(0, row), panel.columns, &sheet.at(x, y + row));
}

}  // namespace

volume::SlicePlane whole_coronal(const volume::GridGeometry& grid, const Vec3& middle, int pixels) {
  return whole_plane(grid, middle, 0, pixels);
}

volume::SlicePlane whole_sagittal(const volume::GridGeometry& grid, const Vec3& middle, int pixels) {
  return whole_plane(grid, middle, 1, pixels);
}

image::RgbImage paint_motion(const anatomy::VirtualPatient& patient, const motion::MotionModel& model,
                             const MotionSheet& sheet) {
  constexpr int kGap = 4, kText = 6;
  constexpr image::Rgb kWhite{255, 255, 255};
  const int pixels = std::clamp(sheet.panel_pixels, 64, 2000);
  const volume::GridGeometry& grid = patient.ct.geometry;
  const std::array<volume::SlicePlane, 2> planes{whole_coronal(grid, sheet.middle_A, pixels),
                                                 whole_sagittal(grid, sheet.middle_A, pixels)};
  motion::MotionState from_state, to_state;
  from_state.drivers = sheet.from;
  to_state.drivers = sheet.to;
  const PatientMotion from(&model, from_state), to(&model, to_state);
  image::RgbImage result(3 * pixels + 2 * kGap, planes[0].rows + planes[1].rows + kGap);
  SliceBuffers buffers;
  image::RgbImage panel;
  for (std::size_t row = 0; row < planes.size(); ++row) {
    const int y = row == 0 ? 0 : planes[0].rows + kGap;
    paint_slice(patient, planes[row], {}, buffers, panel, from);
    image::draw_text(panel, kText, kText, "end-expiration", kWhite, 2);
    paste(panel, 0, y, result);
    paint_slice(patient, planes[row], {}, buffers, panel, to);
    image::draw_text(panel, kText, kText, "end-inspiration", kWhite, 2);
    paste(panel, pixels + kGap, y, result);
    paint_field(patient, from, to, planes[row], sheet.most_mm, panel);
    image::draw_text(panel, kText, kText, fmt::format("motion, red: {:.0f} mm", sheet.most_mm), kWhite, 2);
    paste(panel, 2 * (pixels + kGap), y, result);
  }
  return result;
}

}  // namespace trocar::slices
