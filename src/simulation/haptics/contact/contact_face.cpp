#include "haptics/contact/contact_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::haptics {
namespace {

constexpr double kGelFriction = 0.05;     // [assumed] 0.02..0.2
constexpr double kSkinFriction = 0.5;     // dry skin, typically: Derler, Gerhardt, review of skin friction [V abstract]
constexpr double kProbeReach_mm = 80.0;   // [assumed] 50..120: hand on the housing
constexpr double kFingerReach_mm = 20.0;  // [assumed] 0..60: fingernail to grip

void add_point(ContactFace& face, const Vec3& p_T, const Vec3& n_T, double area_mm2) {
  const auto i = static_cast<std::size_t>(face.count++);
  face.point_T[i] = p_T;
  face.normal_T[i] = n_T;
  face.area_mm2[i] = area_mm2;
}

void set_spread(ContactFace& face, double spread_mm) {
  face.spread_mm = spread_mm;
  for (std::size_t i = 0; i <= kColumnCells; ++i) face.settlement_mm[i] = settlement_mm(kCellBorder_mm[i], spread_mm);
}

}  // namespace

const char* to_string(Tool tool) noexcept {
  switch (tool) {
    case Tool::kNeedle:
      return "needle";
    case Tool::kTransducer:
      return "probe";
    case Tool::kFinger:
      return "finger";
  }
  return "needle";
}

Result<Tool> parse_tool(std::string_view name) {
  for (const Tool tool : {Tool::kNeedle, Tool::kTransducer, Tool::kFinger}) {
    if (name == to_string(tool)) return tool;
  }
  return fail_usage(fmt::format("unknown tool {}", name), "--tool", "use needle, probe or finger");
}

double settlement_mm(double depth_mm, double spread_mm) noexcept {
  // Integral of Boussinesq's stress below the centre of a disc; pi/4 makes the total that of a rigid punch.
  const double a = 0.25 * std::numbers::pi * spread_mm;
  const double r = std::hypot(a, depth_mm);
  return depth_mm - r - a * a / r + 2.0 * a;
}

ContactFace make_transducer_face(double radius_mm, double width_mm, double thickness_mm) {
  constexpr int kColumns = 9;
  constexpr int kRows = 3;
  static_assert(kColumns * kRows <= kMaxContactPoints);
  const double half_angle = std::asin(std::min(1.0, 0.5 * width_mm / radius_mm));
  const double step = 2.0 * half_angle / kColumns;
  ContactFace face;
  for (int column = 0; column < kColumns; ++column) {
    const double phi = -half_angle + (column + 0.5) * step;
    const Vec3 normal(std::sin(phi), std::cos(phi), 0.0);
    for (int row = 0; row < kRows; ++row) {
      const double z = thickness_mm * ((row + 0.5) / kRows - 0.5);
      add_point(face, radius_mm * normal + Vec3(0.0, -radius_mm, z), normal, radius_mm * step * thickness_mm / kRows);
    }
  }
  face.friction_mu = kGelFriction;
  face.lever_mm = 0.5 * width_mm;
  face.reach_mm = kProbeReach_mm;
  set_spread(face, std::sqrt(width_mm * thickness_mm / std::numbers::pi));
  return face;
}

ContactFace make_finger_face(double radius_mm) {
  // Rings between heights above the tip (as a share of the radius), narrow near the first contact: the volume of a
  // shallow indentation is exact to 5 %.
  constexpr std::array<int, 5> kPoints{3, 5, 6, 6, 7};
  constexpr std::array<double, 6> kBorder{0.0, 0.05, 0.15, 0.3, 0.55, 1.0};
  ContactFace face;
  for (std::size_t ring = 0; ring < kPoints.size(); ++ring) {
    const double ring_mm2 = 2.0 * std::numbers::pi * radius_mm * radius_mm * (kBorder[ring + 1] - kBorder[ring]);
    const double up = 1.0 - 0.5 * (kBorder[ring] + kBorder[ring + 1]);
    const double out = std::sqrt(1.0 - up * up);
    for (int i = 0; i < kPoints[ring]; ++i) {
      const double psi = 2.0 * std::numbers::pi * (i + 0.5 * static_cast<double>(ring % 2)) / kPoints[ring];
      const Vec3 normal(out * std::cos(psi), up, out * std::sin(psi));
      add_point(face, radius_mm * (normal - Vec3::UnitY()), normal, ring_mm2 / kPoints[ring]);
    }
  }
  face.friction_mu = kSkinFriction;
  face.lever_mm = radius_mm;
  face.reach_mm = kFingerReach_mm;
  set_spread(face, radius_mm);
  return face;
}

ContactFace make_face(Tool tool) {
  if (tool == Tool::kTransducer) return make_transducer_face();
  if (tool == Tool::kFinger) return make_finger_face();
  return {};
}

Pose tool_in_stylus(const ContactFace& face) noexcept {
  Mat3 R_ST;
  R_ST.col(0) = Vec3::UnitX();
  R_ST.col(1) = Vec3::UnitZ();
  R_ST.col(2) = -Vec3::UnitY();
  return {R_ST, Vec3(0.0, 0.0, face.reach_mm)};
}

}  // namespace trocar::haptics
