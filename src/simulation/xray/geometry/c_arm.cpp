#include "xray/geometry/c_arm.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace trocar::xray {
namespace {

constexpr double kBehindIsocentre_mm = 50.0;  ///< Least distance of the detector behind the isocentre.
constexpr double kRad = std::numbers::pi / 180.0;

struct Limit {
  const char* name;
  double value, low, high;
};

/// Axes of the image in P.
struct ImageAxes {
  Vec3 right, up;
};

ImageAxes image_axes(const CArm& arm) noexcept {
  const double sin_lao = std::sin(arm.lao_deg * kRad), cos_lao = std::cos(arm.lao_deg * kRad);
  const double sin_cranial = std::sin(arm.cranial_deg * kRad), cos_cranial = std::cos(arm.cranial_deg * kRad);
  return {{cos_lao, sin_lao, 0.0}, {-sin_cranial * sin_lao, sin_cranial * cos_lao, cos_cranial}};
}

}  // namespace

Status check_c_arm(const CArm& arm) {
  const Limit limits[] = {
      {"lao_deg", arm.lao_deg, -180.0, 180.0},
      {"cranial_deg", arm.cranial_deg, -90.0, 90.0},
      {"source_isocentre_mm", arm.source_isocentre_mm, 300.0, 1500.0},
      {"source_detector_mm", arm.source_detector_mm, 400.0, 2000.0},
      {"field_mm", arm.field_mm, 50.0, 500.0},
      {"pixels", static_cast<double>(arm.pixels), 16.0, 2048.0},
      {"collimation of the columns", arm.collimation[0], 0.05, 1.0},
      {"collimation of the rows", arm.collimation[1], 0.05, 1.0},
  };
  for (const Limit& limit : limits)
    if (!(limit.value >= limit.low && limit.value <= limit.high))
      return fail_usage(fmt::format("the C-arm's {} is {:g}", limit.name, limit.value), "C-arm",
                        fmt::format("give a value from {:g} to {:g}", limit.low, limit.high));
  if (!arm.isocentre_P.allFinite())
    return fail_usage("the C-arm's isocentre is not finite", "C-arm", "give three finite numbers in mm");
  if (!(arm.source_detector_mm > arm.source_isocentre_mm + kBehindIsocentre_mm))
    return fail_usage(
        fmt::format("the detector, {:g} mm from the source, is not behind the isocentre at {:g} mm",
                    arm.source_detector_mm, arm.source_isocentre_mm),
        "C-arm", fmt::format("give a source_detector_mm above {:g}", arm.source_isocentre_mm + kBehindIsocentre_mm));
  return {};
}

Vec3 towards_detector_P(const CArm& arm) noexcept {
  const double lao = arm.lao_deg * kRad, cranial = arm.cranial_deg * kRad;
  return {std::sin(lao) * std::cos(cranial), -std::cos(lao) * std::cos(cranial), std::sin(cranial)};
}

double magnification(const CArm& arm) noexcept {
  return arm.source_detector_mm / arm.source_isocentre_mm;
}

XrayRays rays_of(const CArm& arm) noexcept {
  const Vec3 towards = towards_detector_P(arm);
  const ImageAxes axes = image_axes(arm);
  const double pixel_mm = arm.field_mm / arm.pixels;
  const double first = 0.5 * (arm.pixels - 1);
  XrayRays rays;
  rays.source_P = arm.isocentre_P - arm.source_isocentre_mm * towards;
  rays.column_P = pixel_mm * axes.right;
  rays.row_P = -pixel_mm * axes.up;
  rays.first_pixel_P = rays.source_P + arm.source_detector_mm * towards - first * rays.column_P - first * rays.row_P;
  rays.columns = rays.rows = arm.pixels;
  return rays;
}

std::array<double, 2> XrayRays::project(const Vec3& p_P) const noexcept {
  const Vec3 normal = column_P.cross(row_P);
  const Vec3 from_source = p_P - source_P;
  const double distance = normal.dot(first_pixel_P - source_P), depth = normal.dot(from_source);
  // Both have one sign for a point on the detector's side of the source.
  if (!(depth * distance > 0.0)) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  const Vec3 on_detector = source_P + (distance / depth) * from_source - first_pixel_P;
  return {on_detector.dot(column_P) / column_P.squaredNorm(), on_detector.dot(row_P) / row_P.squaredNorm()};
}

}  // namespace trocar::xray
