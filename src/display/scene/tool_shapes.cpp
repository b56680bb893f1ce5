#include "scene/tool_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/result.h"
#include "scene/detail/simplify.h"

namespace trocar::scene {
namespace {

using detail::Ring;

constexpr image::Rgb kSteel = {205, 212, 220};
constexpr image::Rgb kDarkSteel = {96, 104, 114};
constexpr image::Rgb kHubBlue = {46, 134, 171};
constexpr image::Rgb kHubYellow = {226, 186, 60};
constexpr image::Rgb kHubBlack = {54, 60, 70};
constexpr image::Rgb kGunGreen = {44, 150, 110};
constexpr image::Rgb kHandleGrey = {120, 130, 142};
constexpr image::Rgb kWhite = {232, 236, 240};
constexpr int kShaftSides = 16;

/// Shape of a needle's tip; lengths in shaft diameters.
struct Tip {
  double bevel = 0.0;     ///< Length of the bevel face.
  double curve = 0.0;     ///< Sideways bend of the end (Tuohy).
  bool is_point = false;  ///< A three-sided point instead.
};

Tip tip_of(NeedleModel model) {
  switch (model) {
    case NeedleModel::kChiba:
      return {2.1, 0.0, false};  // 25 degrees
    case NeedleModel::kTuohy:
      return {1.8, 0.6, false};
    case NeedleModel::kQuincke:
      return {2.6, 0.0, false};
    case NeedleModel::kBiopsyGun:
      return {2.7, 0.0, false};  // 20 degrees
    case NeedleModel::kTrocar:
      return {1.6, 0.0, true};
  }
  return {};
}

/// Frames along a line: z forward, with minimal rotation between points.
std::vector<Pose> frames_along(std::span<const Vec3> line) {
  std::vector<Pose> frames;
  Mat3 R = Mat3::Identity();
  Vec3 forward = Vec3::UnitZ();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 along = line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1];
    const Vec3 next = along.norm() > 1e-9 ? Vec3(along.normalized()) : forward;
    R = rotation_between(forward, next) * R;
    forward = next;
    frames.emplace_back(R, line[i]);
  }
  return frames;
}

std::vector<Vec3> circle(const Pose& X_AL, double radius_mm, int sides) {
  std::vector<Vec3> points;
  for (int s = 0; s < sides; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / sides;
    points.push_back(X_AL * Vec3(radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0.0));
  }
  return points;
}

/// Points on a triangle with corners at `radius_mm`, as many as on a circle.
std::vector<Vec3> triangle(const Pose& X_AL, double radius_mm, int sides) {
  constexpr double kCorner_rad = 2.0 * std::numbers::pi / 3.0;
  std::vector<Vec3> points;
  for (int s = 0; s < sides; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / sides;
    const double from_side_middle = std::fmod(angle, kCorner_rad) - 0.5 * kCorner_rad;
    const double r = radius_mm * std::cos(0.5 * kCorner_rad) / std::cos(from_side_middle);
    points.push_back(X_AL * Vec3(r * std::cos(angle), r * std::sin(angle), 0.0));
  }
  return points;
}

/// The shaft, with its last ring cut to the shape of the tip: the longest point of the bevel is at the end of the line.
TriangleMesh make_shaft(std::span<const Vec3> line, double diameter_mm, const Tip& tip) {
  const double radius_mm = 0.5 * diameter_mm;
  const std::vector<Pose> frames = frames_along(line);
  std::vector<std::vector<Vec3>> rings;
  const Pose& X_AEnd = frames.back();
  const double length_mm = tip.bevel * diameter_mm;
  const auto before_tip = [&](const Pose& X) { return -(X_AEnd.inverse() * X.p()).z() > 1.2 * length_mm; };
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    if (i == 0 || before_tip(frames[i])) rings.push_back(circle(frames[i], radius_mm, kShaftSides));
  }
  const Vec3 lift = tip.curve * diameter_mm * Vec3::UnitY();
  rings.push_back(circle(X_AEnd * Pose::translation(Vec3(0, 0, -1.15 * length_mm)), radius_mm, kShaftSides));
  if (tip.is_point) {
    rings.push_back(triangle(X_AEnd * Pose::translation(Vec3(0, 0, -0.8 * length_mm)), 0.8 * radius_mm, kShaftSides));
    rings.push_back(triangle(X_AEnd, 0.02 * radius_mm, kShaftSides));
    return detail::make_loft(rings);
  }
  std::vector<Vec3> cut;
  for (int s = 0; s < kShaftSides; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / kShaftSides;
    const double back_mm = 0.5 * length_mm * (1.0 + std::sin(angle));  // the face points along +y
    const double share = 1.0 - back_mm / std::max(length_mm, 1e-9);
    cut.push_back(X_AEnd *
                  (Vec3(radius_mm * std::cos(angle), radius_mm * std::sin(angle), -back_mm) + share * share * lift));
  }
  rings.push_back(std::move(cut));
  return detail::make_loft(rings);
}

void add_turned(std::vector<ShapePart>& parts, const Pose& X_AL, std::initializer_list<Ring> rings,
                const image::Rgb& color, double specular = 0.4) {
  parts.push_back({detail::make_turned(X_AL, std::vector<Ring>(rings)), color, specular});
}

void add_box(std::vector<ShapePart>& parts, const Pose& X_AL, const Vec3& middle, const Vec3& half_mm, double corner_mm,
             const image::Rgb& color) {
  parts.push_back({detail::make_box(X_AL * Pose::translation(middle), half_mm, corner_mm), color, 0.35});
}

/// Dark rings every 10 mm of the shaft, as depth marks.
void add_depth_marks(std::vector<ShapePart>& parts, std::span<const Vec3> line, double diameter_mm) {
  constexpr double kStep_mm = 10.0;
  constexpr double kWidth_mm = 1.0;
  double from_tip_mm = 0.0;
  double next_mm = kStep_mm;
  for (std::size_t i = line.size() - 1; i > 0; --i) {
    const Vec3 back = line[i - 1] - line[i];
    const double length_mm = back.norm();
    for (; length_mm > 1e-9 && next_mm < from_tip_mm + length_mm - kWidth_mm; next_mm += kStep_mm) {
      const Vec3 middle = line[i] + (next_mm - from_tip_mm) / length_mm * back;
      const Vec3 half = 0.5 * kWidth_mm / length_mm * back;
      const Vec3 ends[2] = {middle + half, middle - half};
      parts.push_back({make_tube(ends, 0.54 * diameter_mm, kShaftSides), kDarkSteel, 0.2});
    }
    from_tip_mm += length_mm;
  }
}

/// Hubs are built at the pose of the shaft's first point: z towards the tip, so that they are at negative z.
void add_hub(std::vector<ShapePart>& parts, const Pose& X_AH, NeedleModel model, double diameter_mm) {
  switch (model) {
    case NeedleModel::kChiba:
      add_turned(parts, X_AH, {{-22, 3.6}, {-19, 3.6}, {-18.6, 3.0}, {-8, 2.6}, {-2, 1.8}, {0, 0.9}}, kHubBlue);
      add_turned(parts, X_AH, {{-29, 2.4}, {-28.4, 3.2}, {-22.5, 3.2}, {-22, 2.6}}, kWhite);
      return;
    case NeedleModel::kTuohy:
      add_turned(parts, X_AH, {{-26, 3.4}, {-24, 3.4}, {-23, 2.8}, {-6, 2.6}, {0, 1.2}}, kHubYellow);
      add_box(parts, X_AH, {0, 0, -9}, {17.0, 0.9, 4.5}, 0.8, kHubYellow);
      add_turned(parts, X_AH, {{-31, 2.6}, {-26, 2.8}}, kWhite);
      return;
    case NeedleModel::kQuincke:
      add_turned(parts, X_AH, {{-17, 3.4}, {-15.5, 3.4}, {-15, 2.5}, {-4, 2.1}, {0, 0.9}}, kHubBlack);
      add_box(parts, X_AH, {0, 0, -22}, {3.2, 1.4, 5.0}, 1.2, kHubBlack);
      return;
    case NeedleModel::kBiopsyGun:
      add_turned(parts, X_AH, {{-14, 4.2}, {-4, 3.4}, {0, 1.6}}, kWhite);
      add_box(parts, X_AH, {0, 0, -74}, {11.0, 8.0, 60.0}, 4.0, kGunGreen);
      add_box(parts, X_AH, {0, 8.5, -60}, {5.5, 1.5, 14.0}, 1.4, kWhite);
      add_turned(parts, X_AH, {{-146, 6.5}, {-144, 7.0}, {-138, 7.0}, {-134, 5.0}}, kHandleGrey);
      return;
    case NeedleModel::kTrocar: {
      const double collar_mm = std::max(6.0, 2.2 * diameter_mm);
      add_turned(parts, X_AH, {{-8, 0.8 * collar_mm}, {-6, collar_mm}, {-2, collar_mm}, {0, 0.6 * collar_mm}},
                 kHandleGrey);
      add_turned(parts, X_AH, {{-26, 5.0}, {-8, 4.4}}, kSteel, 0.7);
      add_turned(parts, X_AH,
                 {{-52, 2.0}, {-51, 6.0}, {-48, 10.0}, {-43, 13.0}, {-38, 14.0}, {-32, 12.5}, {-28, 9.0}, {-25, 5.0}},
                 kHubBlack);
      return;
    }
  }
}

/// The notch of a biopsy stylet: a dark flat surface on the bevel's side, behind the tip.
void add_notch(std::vector<ShapePart>& parts, const Pose& X_AEnd, double diameter_mm) {
  constexpr double kDeadSpace_mm = 3.0;
  constexpr double kNotch_mm = 19.0;
  const Pose X_AMiddle = X_AEnd * Pose::translation(Vec3(0, 0.36 * diameter_mm, -kDeadSpace_mm - 0.5 * kNotch_mm));
  parts.push_back(
      {detail::make_box(X_AMiddle, Vec3(0.36 * diameter_mm, 0.18 * diameter_mm, 0.5 * kNotch_mm)), kDarkSteel, 0.1});
}

}  // namespace

NeedleModel needle_model(std::string_view name) noexcept {
  constexpr std::pair<std::string_view, NeedleModel> kModels[] = {{"tuohy", NeedleModel::kTuohy},
                                                                  {"quincke", NeedleModel::kQuincke},
                                                                  {"biopsy-gun", NeedleModel::kBiopsyGun},
                                                                  {"trocar", NeedleModel::kTrocar}};
  for (const auto& [known, model] : kModels)
    if (name == known) return model;
  return NeedleModel::kChiba;
}

std::vector<ShapePart> make_needle_shape(std::span<const Vec3> shaft, double diameter_mm, NeedleModel model,
                                         double least_diameter_mm) {
  TROCAR_CHECK(shaft.size() >= 2);
  const double shown_mm = std::max(diameter_mm, least_diameter_mm);
  const std::vector<Pose> frames = frames_along(shaft);
  std::vector<ShapePart> parts;
  parts.push_back({make_shaft(shaft, shown_mm, tip_of(model)), kSteel, 0.8});
  add_hub(parts, frames.front(), model, diameter_mm);
  if (model == NeedleModel::kChiba || model == NeedleModel::kTuohy) add_depth_marks(parts, shaft, shown_mm);
  if (model == NeedleModel::kBiopsyGun) add_notch(parts, frames.back(), shown_mm);
  return parts;
}

TriangleMesh make_tube(std::span<const Vec3> line, double radius_mm, int sides) {
  TROCAR_CHECK(line.size() >= 2);
  std::vector<std::vector<Vec3>> rings;
  for (const Pose& frame : frames_along(line)) rings.push_back(circle(frame, radius_mm, sides));
  return detail::make_loft(rings);
}

TriangleMesh make_ball(const Vec3& center, double radius_mm) {
  constexpr int kRings = 12;
  std::vector<Ring> rings;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = std::numbers::pi * i / kRings;
    rings.push_back({-radius_mm * std::cos(angle), radius_mm * std::max(1e-3, std::sin(angle))});
  }
  return detail::make_turned(Pose::translation(center), rings);
}

namespace {

constexpr image::Rgb kLensGrey = {92, 100, 112};
constexpr image::Rgb kShell = {214, 220, 227};
constexpr image::Rgb kHandle = {176, 186, 198};
constexpr image::Rgb kMark = {79, 179, 217};
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
