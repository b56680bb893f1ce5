#include "scene/detail/tool_layer.h"

#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/result.h"
#include "scene/tool_shapes.h"

namespace trocar::scene::detail {
namespace {

constexpr double kTranslucentTransducer = 0.3;
constexpr double kGhostOpacity = 0.4;
constexpr double kGhostRadius_mm = 1.2;
constexpr double kGhostHubRadius_mm = 4.0;
constexpr double kGhostHub_mm = 22.0;
constexpr image::Rgb kGhostColor = {150, 205, 255};
constexpr double kStyletRadius_mm = 0.8;  // drawn thicker than in reality for visibility, like the needle
constexpr image::Rgb kStyletColor = {236, 240, 246};
constexpr double kCoreRadius_mm = 1.6;  // around the needle
constexpr image::Rgb kCoreColor = {255, 138, 61};
constexpr double kThrowRadius_mm = 0.5, kNotchRadius_mm = 1.0, kThrowDash_mm = 1.5;
constexpr image::Rgb kThrowColor = {236, 240, 246};
/// A smaller relative change of the minimum thickness does not rebuild the needle.
constexpr double kThicknessStep = 0.15;

/// Compares the appearance of faces: the number of scanlines of a live scan changes, and with it the last digits of its
/// width.
bool are_alike(const TransducerFace& a, const TransducerFace& b) {
  constexpr double kUnseen_rad = 1e-4;
  return a.is_convex == b.is_convex && std::abs(a.radius_mm - b.radius_mm) < kUnseen_mm &&
         std::abs(a.field_of_view_rad - b.field_of_view_rad) < kUnseen_rad &&
         std::abs(a.width_mm - b.width_mm) < kUnseen_mm && std::abs(a.least_width_mm - b.least_width_mm) < kUnseen_mm;
}

bool are_close(std::span<const Vec3> a, std::span<const Vec3> b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](const Vec3& p, const Vec3& q) { return (p - q).norm() < kUnseen_mm; });
}

bool are_same(const std::optional<Segment>& a, const std::optional<Segment>& b) {
  if (!a || !b) return !a && !b;
  return (a->a - b->a).norm() < kUnseen_mm && (a->b - b->b).norm() < kUnseen_mm;
}

}  // namespace

vtkSmartPointer<vtkActor> make_tool(vtkRenderer& renderer) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  vtkNew<vtkPolyData> nothing;
  auto mapper = make_mapper(nothing);
  mapper->ScalarVisibilityOn();
  mapper->SetColorModeToDirectScalars();
  actor->SetMapper(mapper);
  apply(Appearance{{255, 255, 255}, 1.0, 0.5, 0.16}, *actor);
  actor->VisibilityOff();
  renderer.AddActor(actor);
  return actor;
}

void set_data(vtkActor& tool, vtkPolyData* data) {
  static_cast<vtkPolyDataMapper*>(tool.GetMapper())->SetInputData(data);
}

vtkSmartPointer<vtkPolyData> to_colored_polydata(std::span<const ShapePart> parts) {
  TriangleMesh all;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const ShapePart& part : parts) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.mesh.vertices.begin(), part.mesh.vertices.end());
    for (const auto& t : part.mesh.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) colors->InsertNextTypedTuple(part.color.data());
  }
  auto data = to_polydata(all);
  data->GetPointData()->SetScalars(colors);
  return data;
}

ToolLayer::ToolLayer(vtkRenderer& renderer)
    : needle_(make_tool(renderer)),
      ghost_(make_tool(renderer)),
      shot_(make_tool(renderer)),
      throw_(make_tool(renderer)),
      transducer_(make_tool(renderer)) {
  ghost_->GetProperty()->SetOpacity(kGhostOpacity);
  ghost_->GetProperty()->BackfaceCullingOn();
  blend_at_once(*ghost_);
  make_unlit(*ghost_);
  make_unlit(*throw_);
  renderer.AddActor(ultrasound_.actor());
}

bool ToolLayer::set_needle(std::span<const Vec3> shaft_P, double diameter_mm, NeedleModel model) {
  if (are_close(shaft_P, shaft_P_) && diameter_mm == diameter_mm_ && model == model_) return false;
  shaft_P_.assign(shaft_P.begin(), shaft_P.end());
  diameter_mm_ = diameter_mm;
  model_ = model;
  rebuild_needle();
  return true;
}

void ToolLayer::rebuild_needle() {
  needle_->SetVisibility(shaft_P_.size() >= 2);
  if (shaft_P_.size() < 2) return;
  set_data(*needle_, to_colored_polydata(make_needle_shape(shaft_P_, diameter_mm_, model_, least_mm_)));
}

void ToolLayer::set_least_thickness(double least_mm) {
  if (std::max(least_mm, least_mm_) <= diameter_mm_) return;
  if (std::abs(least_mm - least_mm_) <= kThicknessStep * least_mm_) return;
  least_mm_ = least_mm;
  rebuild_needle();
}

bool ToolLayer::set_needle_goal(const std::optional<Segment>& ghost_P) {
  if (are_same(ghost_P, ghost_P_)) return false;
  ghost_P_ = ghost_P;
  ghost_->SetVisibility(ghost_P.has_value());
  if (!ghost_P) return true;
  const Vec3 hub_end_P = ghost_P->a - kGhostHub_mm * ghost_P->direction();
  const Vec3 shaft_P[2] = {ghost_P->a, ghost_P->b};
  const Vec3 hub_P[2] = {hub_end_P, ghost_P->a};
  const ShapePart parts[2] = {{make_tube(shaft_P, kGhostRadius_mm), kGhostColor},
                              {make_tube(hub_P, kGhostHubRadius_mm), kGhostColor}};
  set_data(*ghost_, to_colored_polydata(parts));
  return true;
}

bool ToolLayer::set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P) {
  if (are_same(stylet_P, stylet_P_) && are_same(core_P, core_P_)) return false;
  stylet_P_ = stylet_P;
  core_P_ = core_P;
  shot_->SetVisibility(stylet_P || core_P);
  std::vector<ShapePart> parts;
  const auto add = [&](const std::optional<Segment>& piece_P, double radius_mm, const image::Rgb& color) {
    if (!piece_P || piece_P->length_mm() < kUnseen_mm) return;
    const Vec3 ends_P[2] = {piece_P->a, piece_P->b};
    parts.push_back({make_tube(ends_P, radius_mm), color});
  };
  add(stylet_P, kStyletRadius_mm, kStyletColor);
  add(core_P, kCoreRadius_mm, kCoreColor);
  set_data(*shot_, to_colored_polydata(parts));
  return true;
}

/// Dashes, as no stylet is there yet; those of the notch are thicker.
bool ToolLayer::set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P) {
  if (are_same(throw_P, throw_P_) && are_same(notch_P, notch_P_)) return false;
  throw_P_ = throw_P;
  notch_P_ = notch_P;
  throw_->SetVisibility(throw_P.has_value());
  if (!throw_P) return true;
  std::vector<ShapePart> parts;
  const Vec3 along_P = throw_P->direction();
  const double from_mm = notch_P ? (notch_P->a - throw_P->a).dot(along_P) : 0.0;
  const double to_mm = notch_P ? (notch_P->b - throw_P->a).dot(along_P) : 0.0;
  for (double at_mm = 0.0; at_mm < throw_P->length_mm(); at_mm += 2.0 * kThrowDash_mm) {
    const double end_mm = std::min(at_mm + kThrowDash_mm, throw_P->length_mm()), middle_mm = 0.5 * (at_mm + end_mm);
    const bool is_notch = middle_mm > from_mm && middle_mm < to_mm;
    const Vec3 ends_P[2] = {throw_P->a + at_mm * along_P, throw_P->a + end_mm * along_P};
    parts.push_back({make_tube(ends_P, is_notch ? kNotchRadius_mm : kThrowRadius_mm), kThrowColor});
  }
  set_data(*throw_, to_colored_polydata(parts));
  return true;
}

bool ToolLayer::set_transducer(const std::optional<Pose>& X_PT, const TransducerFace& face) {
  const bool is_same_face = face_ && are_alike(*face_, face);
  if (!X_PT && !X_PT_) return false;
  if (X_PT && X_PT_ && is_same_face && (X_PT->p() - X_PT_->p()).norm() < kUnseen_mm &&
      (X_PT->R() - X_PT_->R()).norm() < 1e-5)
    return false;
  X_PT_ = X_PT;
  transducer_->SetVisibility(X_PT.has_value());
  if (!X_PT) return true;
  if (!is_same_face) {
    face_ = face;
    set_data(*transducer_, to_colored_polydata(make_transducer_shape(face)));
  }
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix->SetElement(row, column, X_PT->R()(row, column));
    matrix->SetElement(row, 3, X_PT->p()[row]);
  }
  transducer_->SetUserMatrix(matrix);
  return true;
}

bool ToolLayer::set_picture(const ScanView& scan) {
  if (scan.picture.bytes.empty()) return ultrasound_.hide();
  TROCAR_CHECK(scan.alpha.empty() || scan.alpha.size() * scan.picture.channels == scan.picture.bytes.size());
  if (scan.number > 0 && scan.number == picture_number_) return false;
  picture_number_ = scan.number;
  return ultrasound_.show_picture(scan.picture, scan.alpha, scan.corners_P);
}

bool ToolLayer::set_scan(const std::optional<ScanView>& scan) {
  const bool has_moved =
      set_transducer(scan ? std::optional(scan->X_PT) : std::nullopt, scan ? scan->face : TransducerFace{});
  if (!scan) picture_number_ = 0;
  return (scan ? set_picture(*scan) : ultrasound_.hide()) || has_moved;
}

void ToolLayer::set_transducer_translucent(bool is_translucent) {
  transducer_->GetProperty()->SetOpacity(is_translucent ? kTranslucentTransducer : 1.0);
  transducer_->GetProperty()->SetBackfaceCulling(is_translucent);
}

std::optional<Segment> ToolLayer::needle_P() const noexcept {
  if (shaft_P_.size() < 2) return std::nullopt;
  return Segment{shaft_P_.front(), shaft_P_.back()};
}

namespace {

constexpr double kFingerRadius_mm = 7.0;
constexpr double kFingerLength_mm = 45.0;
constexpr double kLean = 1.2;  ///< Of the finger's axis, against the skin's normal.
constexpr double kAround_mm = 11.0, kFingerRing_mm = 1.3;
constexpr double kMarkRadius_mm = 3.0;
constexpr double kSamePlace_mm = 0.05;
constexpr image::Rgb kFingerColor = {0xd9, 0xb3, 0x9a};
constexpr image::Rgb kMarkColor = {0x9a, 0x4d, 0xff};  ///< Of a surgical skin marker.

bool are_same_touch(const std::optional<Fingertip>& a, const std::optional<Fingertip>& b) {
  if (!a || !b) return !a && !b;
  return (a->p_P - b->p_P).norm() < kSamePlace_mm && (a->inward_P - b->inward_P).norm() < 1e-3 && a->color == b->color;
}

/// Circle on the skin about the fingertip.
std::vector<Vec3> ring_about(const Fingertip& finger) {
  constexpr int kPoints = 40;
  constexpr double kAbove_mm = 1.0;
  const Vec3 u_P = finger.inward_P.unitOrthogonal(), v_P = finger.inward_P.cross(u_P);
  std::vector<Vec3> ring_P;
  for (int n = 0; n <= kPoints; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kPoints;
    ring_P.push_back(finger.p_P - kAbove_mm * finger.inward_P +
                     kAround_mm * (std::cos(angle) * u_P + std::sin(angle) * v_P));
  }
  return ring_P;
}

}  // namespace

HandLayer::HandLayer(vtkRenderer& renderer) : finger_actor_(make_tool(renderer)), marks_actor_(make_tool(renderer)) {}

bool HandLayer::set(const std::optional<Fingertip>& finger, std::span<const Vec3> skin_marks_P) {
  const bool has_moved = set_finger(finger);
  return set_marks(skin_marks_P) || has_moved;
}

bool HandLayer::set_finger(const std::optional<Fingertip>& finger) {
  if (are_same_touch(finger, finger_)) return false;
  finger_ = finger;
  finger_actor_->SetVisibility(finger.has_value());
  if (!finger) return true;
  // Leaning towards the feet, so that it does not cover the place that it feels.
  const Vec3 outward_P = -finger->inward_P;
  const Vec3 feet_P = -Vec3::UnitZ() + outward_P.z() * outward_P;
  const Vec3 axis_P = (outward_P + kLean * feet_P).normalized();
  const Vec3 end_P = finger->p_P + kFingerRadius_mm * outward_P;
  const Vec3 line_P[2] = {end_P, end_P + kFingerLength_mm * axis_P};
  const ShapePart parts[3] = {{make_tube(line_P, kFingerRadius_mm), kFingerColor, 0.1},
                              {make_ball(end_P, kFingerRadius_mm), kFingerColor, 0.1},
                              {make_tube(ring_about(*finger), kFingerRing_mm), finger->color, 0.1}};
  set_data(*finger_actor_, to_colored_polydata(parts));
  return true;
}

bool HandLayer::set_marks(std::span<const Vec3> marks_P) {
  if (std::equal(marks_P.begin(), marks_P.end(), marks_P_.begin(), marks_P_.end())) return false;
  marks_P_.assign(marks_P.begin(), marks_P.end());
  marks_actor_->SetVisibility(!marks_P_.empty());
  std::vector<ShapePart> parts;
  for (const Vec3& mark_P : marks_P_) parts.push_back({make_ball(mark_P, kMarkRadius_mm), kMarkColor, 0.1});
  if (!parts.empty()) set_data(*marks_actor_, to_colored_polydata(parts));
  return true;
}

}  // namespace trocar::scene::detail
