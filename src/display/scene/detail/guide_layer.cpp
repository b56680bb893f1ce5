#include "scene/detail/guide_layer.h"

#include <vtkCoordinate.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "motion/rest_plane.h"
#include "scene/tool_shapes.h"
#include "volume/sampling.h"

namespace trocar::scene::detail {
namespace {

// The trainer's colours of path and target (ui_kit/theme.h).
constexpr image::Rgb kPathColor = {0x54, 0xd1, 0xc4};
constexpr image::Rgb kOtherPathColor = {0xc3, 0xcc, 0xd8};
constexpr image::Rgb kTargetColor = {0xff, 0x8a, 0x3d};
constexpr image::Rgb kLandmarkColor = {0xf2, 0xd0, 0x6b};
constexpr double kPathRadius_mm = 1.0;
constexpr double kPathDash_mm = 6.0;
constexpr double kPathGap_mm = 4.0;
constexpr double kPathOutside_mm = 45.0;  ///< Length of the path drawn outside the skin.
constexpr double kTargetRadius_mm = 3.0;
constexpr double kEntryRing_mm = 0.9;
constexpr double kFont_px = 13.0;  ///< At a text scale of 1.
constexpr double kBesideMark_px = 8.0;
constexpr double kFarBehind_mm = 25.0;
constexpr double kLandmarkRadius_mm = 3.0;
constexpr double kAboveSkin_mm = 0.6;

/// Intersection of the skin with the line through p along the path, at rest.
Vec3 onto_skin(const Vec3& p_A, const Vec3& along_A, const volume::FloatGrid& skin_distance_mm) {
  constexpr int kSteps = 12;
  constexpr double kFarthest_mm = 30.0;
  if (skin_distance_mm.empty()) return p_A;
  double moved_mm = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const double distance_mm = volume::sample_linear(skin_distance_mm, p_A + moved_mm * along_A);
    moved_mm += distance_mm - kAboveSkin_mm;
    if (std::abs(distance_mm - kAboveSkin_mm) < 0.05) break;
  }
  return std::abs(moved_mm) < kFarthest_mm ? Vec3(p_A + moved_mm * along_A) : p_A;
}

std::vector<Vec3> entry_ring(const EntryMark& entry, const Vec3& along_A, const volume::FloatGrid& skin_distance_mm) {
  constexpr int kPoints = 72;
  const Vec3 u_A = along_A.unitOrthogonal();
  const Vec3 v_A = along_A.cross(u_A);
  std::vector<Vec3> ring_A;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    ring_A.push_back(onto_skin(entry.centre_A + entry.radius_mm * (std::cos(angle) * u_A + std::sin(angle) * v_A),
                               along_A, skin_distance_mm));
  }
  return ring_A;
}

/// Interior of the ring: a fan around its centre.
TriangleMesh disc(const std::vector<Vec3>& ring_P, const Vec3& middle_P) {
  TriangleMesh mesh;
  mesh.vertices.push_back(middle_P.cast<float>());
  for (const Vec3& p_P : ring_P) mesh.vertices.push_back(p_P.cast<float>());
  for (std::uint32_t i = 1; i + 1 < mesh.vertices.size(); ++i) mesh.triangles.push_back({0, i + 1, i});
  return mesh;
}

TriangleMesh dashes(const Segment& line_P) {
  TriangleMesh all;
  const double length_mm = line_P.length_mm();
  for (double from_mm = -kPathOutside_mm; from_mm < length_mm - kTargetRadius_mm;
       from_mm += kPathDash_mm + kPathGap_mm) {
    const double to_mm = std::min(from_mm + kPathDash_mm, length_mm);
    const Vec3 ends_P[2] = {line_P.a + from_mm * line_P.direction(), line_P.a + to_mm * line_P.direction()};
    const TriangleMesh dash = make_tube(ends_P, kPathRadius_mm, 10);
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), dash.vertices.begin(), dash.vertices.end());
    for (const auto& t : dash.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

}  // namespace

void GuideLayer::clear(Props& props) {
  for (const auto& prop : props) renderer_.RemoveViewProp(prop);
  props.clear();
}

void GuideLayer::add_mesh(Props& props, const TriangleMesh& mesh_P, const image::Rgb& color, double opacity,
                          bool is_lit) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(make_mapper(to_polydata(mesh_P)));
  apply(Appearance{color, opacity, 0.2, 0.35}, *actor);
  actor->GetProperty()->BackfaceCullingOff();
  if (!is_lit) make_unlit(*actor);
  if (opacity < 1.0) blend_at_once(*actor);
  renderer_.AddActor(actor);
  props.push_back(actor);
}

void GuideLayer::add_text(const Vec3& p_P, const std::string& text, const image::Rgb& color) {
  auto label = vtkSmartPointer<vtkTextActor>::New();
  label->SetInput(text.c_str());
  // Next to the mark, and on top of everything, so that names are never partly hidden.
  vtkNew<vtkCoordinate> mark;
  mark->SetCoordinateSystemToWorld();
  mark->SetValue(p_P.x(), p_P.y(), p_P.z());
  label->GetPositionCoordinate()->SetCoordinateSystemToViewport();
  label->GetPositionCoordinate()->SetReferenceCoordinate(mark);
  vtkTextProperty& look = *label->GetTextProperty();
  look.SetColor(color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
  look.SetBackgroundColor(0.04, 0.05, 0.07);
  renderer_.AddViewProp(label);
  landmarks_.push_back(label);
  texts_.push_back({label, p_P});
}

bool GuideLayer::set_text_scale(double scale) {
  if (scale == text_scale_) return false;
  text_scale_ = scale;
  scale_texts();
  return are_landmarks_visible_ && !texts_.empty();
}

void GuideLayer::scale_texts() {
  for (const Text& text : texts_) {
    text.actor->GetTextProperty()->SetFontSize(std::max(4, static_cast<int>(std::lround(kFont_px * text_scale_))));
    text.actor->GetPositionCoordinate()->SetValue(kBesideMark_px * text_scale_, 0.75 * kBesideMark_px * text_scale_);
  }
}

void GuideLayer::look_from(const CameraView& view) {
  for (const Text& text : texts_) {
    const bool is_far = (text.p_P - view.focus_P).dot(view.forward_P()) > kFarBehind_mm;
    text.actor->GetTextProperty()->SetOpacity(is_far ? 0.35 : 1.0);
    text.actor->GetTextProperty()->SetBackgroundOpacity(is_far ? 0.2 : 0.8);
  }
}

void GuideLayer::set_path(const std::optional<Segment>& line_A, const EntryMark& entry,
                          const volume::FloatGrid& skin_distance_mm, const motion::PatientMotion& motion) {
  clear(line_);
  clear(marks_);
  if (!line_A || !(line_A->length_mm() > 0.0)) return;
  const Vec3 along_A = line_A->direction();
  const Segment line_P{motion.to_now(line_A->a), motion.to_now(line_A->b)};
  add_mesh(line_, dashes(line_P), kPathColor, 1.0, false);
  add_mesh(marks_, make_ball(line_P.b, kTargetRadius_mm), kTargetColor, 1.0, true);
  std::vector<Vec3> ring = entry_ring(entry, along_A, skin_distance_mm);
  for (Vec3& point : ring) point = motion.to_now(point);
  const Vec3 middle_P = motion.to_now(onto_skin(entry.centre_A, along_A, skin_distance_mm));
  add_mesh(marks_, make_tube(ring, kEntryRing_mm, 8), kPathColor, 1.0, false);
  add_mesh(marks_, disc(ring, middle_P), kPathColor, 0.3, false);
  show_guidance();
}

void GuideLayer::set_motion(const motion::PatientMotion& motion) {
  motion_ = motion;
  draw_others();
  draw_landmarks();
}

void GuideLayer::set_other_paths(std::span<const Segment> lines_A) {
  others_A_.assign(lines_A.begin(), lines_A.end());
  draw_others();
}

void GuideLayer::draw_others() {
  constexpr double kFaint = 0.8;
  clear(others_);
  for (const Segment& line_A : others_A_)
    if (line_A.length_mm() > 0.0)
      add_mesh(others_, dashes({motion_.to_now(line_A.a), motion_.to_now(line_A.b)}), kOtherPathColor, kFaint, false);
  show_guidance();
}

void GuideLayer::show_guidance() {
  for (const Props* props : {&line_, &others_})
    for (const auto& prop : *props) prop->SetVisibility(is_guidance_visible_ && guidance_ == Guidance::kPath);
  for (const auto& prop : marks_) prop->SetVisibility(is_guidance_visible_ && guidance_ != Guidance::kNone);
}

void GuideLayer::set_landmarks(const std::vector<anatomy::Landmark>& landmarks) {
  landmarks_A_ = landmarks;
  draw_landmarks();
}

void GuideLayer::draw_landmarks() {
  clear(landmarks_);
  texts_.clear();
  for (const anatomy::Landmark& landmark : landmarks_A_) {
    const Vec3 p_P = motion_.to_now(landmark.p_P);
    add_mesh(landmarks_, make_ball(p_P, kLandmarkRadius_mm), kLandmarkColor, 1.0, true);
    add_text(p_P, landmark.name, kLandmarkColor);
  }
  scale_texts();
  for (const auto& prop : landmarks_) prop->SetVisibility(are_landmarks_visible_);
}

bool GuideLayer::set_guidance(Guidance guidance) {
  if (std::exchange(guidance_, guidance) == guidance) return false;
  show_guidance();
  return true;
}

bool GuideLayer::set_guidance_visible(bool is_visible) {
  if (std::exchange(is_guidance_visible_, is_visible) == is_visible) return false;
  show_guidance();
  return true;
}

bool GuideLayer::set_landmarks_visible(bool are_visible) {
  if (are_visible == are_landmarks_visible_) return false;
  are_landmarks_visible_ = are_visible;
  for (const auto& prop : landmarks_) prop->SetVisibility(are_visible);
  return true;
}

}  // namespace trocar::scene::detail
