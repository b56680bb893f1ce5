#include "scene/transducer_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/detail/solids.h"

namespace trocar::scene {
namespace {

constexpr volume::Rgb kLensGrey = {92, 100, 112};
constexpr volume::Rgb kShell = {214, 220, 227};
constexpr volume::Rgb kHandle = {176, 186, 198};
constexpr volume::Rgb kMark = {79, 179, 217};
constexpr int kHousingSides = 40;
constexpr double kShellRim_mm = 4.0;       ///< Of the shell around the outermost elements.
constexpr double kHalfElevation_mm = 9.0;  ///< Half the lens' height.

/// A cross section of the housing at height y: half sizes along x and z.
struct Section {
  double y;
  double half_x;
  double half_z;
};

/// A rounded rectangle (superellipse), counter-clockwise seen from -y, lowered by the face's arc towards its sides.
std::vector<Vec3> outline(const Section& section, double arc_radius_mm) {
  constexpr double kPower = 0.55;  // 1: an ellipse, 0: a rectangle
  std::vector<Vec3> points;
  for (int s = 0; s < kHousingSides; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / kHousingSides;
    const double c = std::cos(angle), d = std::sin(angle);
    const double x = section.half_x * std::copysign(std::pow(std::abs(c), kPower), c);
    const double z = section.half_z * std::copysign(std::pow(std::abs(d), kPower), d);
    const double sink =
        arc_radius_mm > std::abs(x) ? arc_radius_mm - std::sqrt(arc_radius_mm * arc_radius_mm - x * x) : 0.0;
    points.emplace_back(x, section.y - sink, z);
  }
  return points;
}

TriangleMesh make_housing(std::initializer_list<Section> sections, double arc_radius_mm) {
  std::vector<std::vector<Vec3>> rings;
  for (const Section& section : sections) rings.push_back(outline(section, arc_radius_mm));
  return detail::make_loft(rings);
}

}  // namespace

std::vector<ShapePart> make_transducer_shape(const TransducerFace& face) {
  const bool is_arc = face.is_convex && face.radius_mm > 0.0;
  const double half_face_mm = is_arc ? face.radius_mm * std::sin(std::min(1.5, 0.5 * face.field_of_view_rad))
                                     : 0.5 * std::max(face.width_mm, face.least_width_mm);
  const double wide = half_face_mm + kShellRim_mm;
  const double arc_mm = is_arc ? std::max(face.radius_mm, 1.02 * wide) : 0.0;
  const double sink_mm = is_arc ? arc_mm - std::sqrt(arc_mm * arc_mm - wide * wide) : 0.0;
  const double grip = std::min(wide, 15.0);
  const double z = kHalfElevation_mm;

  std::vector<ShapePart> parts;
  // The lens: concentric outlines from its centre, so that the arc is visible.
  parts.push_back({make_housing({{0.0, 0.02 * wide, 0.02 * z},
                                 {0.0, 0.35 * wide, 0.55 * z},
                                 {-0.1, 0.7 * wide, 0.8 * z},
                                 {-0.8, 0.94 * wide, 0.95 * z},
                                 {-3.0, wide, z}},
                                arc_mm),
                   kLensGrey, 0.3});
  const double back = -3.0 - sink_mm;
  parts.push_back({make_housing({{-3.0, wide, z}, {-9.0, 1.03 * wide, 1.15 * z}}, arc_mm), kShell, 0.4});
  const double neck = back - std::max(16.0, 0.7 * wide);
  parts.push_back({make_housing({{back - 2.0, 1.0 * wide, 1.12 * z},
                                 {back - 8.0, 1.0 * wide, 1.3 * z},
                                 {0.5 * (back + neck), 0.5 * (wide + grip), 1.45 * z},
                                 {neck, grip, 1.4 * z},
                                 {neck - 45.0, 0.9 * grip, 1.3 * z},
                                 {neck - 56.0, 0.7 * grip, 0.9 * z}},
                                0.0),
                   kHandle, 0.35});
  const Vec3 cable[3] = {{0, neck - 56.0, 0}, {0, neck - 75.0, 0}, {0, neck - 110.0, 8.0}};
  parts.push_back({make_tube(cable, 3.5), kLensGrey, 0.2});
  parts.push_back({make_ball({wide + 0.5, back - 6.0, 0}, 2.6), kMark, 0.4});
  return parts;
}

}  // namespace trocar::scene
