#include "scene/detail/plane_layer.h"

#include <algorithm>
#include <cmath>

#include "motion/rest_plane.h"
#include "volume/sampling.h"

namespace trocar::scene::detail {
namespace {

constexpr float kOutside_hu = -32768.0F;
constexpr double kSamePlanes_mm = 0.02;  ///< A needle that moves less does not change the pictures.
/// The air around the patient is not drawn, as it would hide structures behind it. Distance from the skin at which the
/// plane ends.
constexpr double kBeyondSkin_mm = 0.5;

bool have_same_planes(const std::optional<Segment>& a, const std::optional<Segment>& b) {
  if (!a || !b) return !a && !b;
  return (a->a - b->a).norm() < kSamePlanes_mm && (a->b - b->b).norm() < kSamePlanes_mm;
}

}  // namespace

PlaneLayer::PlaneLayer(vtkRenderer& renderer) {
  for (const PictureQuad& quad : quads_) renderer.AddActor(quad.actor());
}

void PlaneLayer::set_patient(const anatomy::VirtualPatient* patient) noexcept {
  patient_ = patient;
  drawn_pixels_ = 0;
}

bool PlaneLayer::set_options(const MprOptions& options) {
  if (options == options_) return false;
  options_ = options;
  drawn_pixels_ = 0;
  return true;
}

void PlaneLayer::set_motion(const motion::PatientMotion& motion) {
  motion_ = motion;
  drawn_pixels_ = 0;
}

void PlaneLayer::update(const std::optional<Segment>& needle_P, int pixels) {
  if (pixels == drawn_pixels_ && have_same_planes(needle_P, drawn_for_P_)) return;
  drawn_for_P_ = needle_P;
  drawn_pixels_ = pixels;
  for (PictureQuad& quad : quads_) quad.hide();
  if (patient_ == nullptr || patient_->ct.empty() || !needle_P || !(needle_P->length_mm() > 0.0)) return;
  const Vec3 axis_P = needle_P->direction();
  // The first plane contains the axis and the perpendicular direction nearest to axial.
  const Vec3 across_P = std::abs(axis_P.z()) < 0.95 ? Vec3(axis_P.cross(Vec3::UnitZ()).normalized())
                                                    : Vec3(axis_P.cross(Vec3::UnitY()).normalized());
  const Vec3 third_P = axis_P.cross(across_P);
  const Vec3& tip_P = needle_P->b;
  if (options_.has_long_plane) draw(quads_[0], tip_P, across_P, axis_P, pixels);
  if (options_.has_cross_plane) draw(quads_[1], tip_P, third_P, axis_P, pixels);
  if (options_.has_tip_plane) draw(quads_[2], tip_P, across_P, third_P, pixels);
}

void PlaneLayer::draw(PictureQuad& quad, const Vec3& middle_P, const Vec3& right_P, const Vec3& down_P, int pixels) {
  const double step_mm = options_.size_mm / pixels;
  const Vec3 corner_P = middle_P - 0.5 * options_.size_mm * (right_P + down_P);
  volume::SlicePlane plane;
  plane.origin_P = corner_P + 0.5 * step_mm * (right_P + down_P);
  plane.step_u_P = step_mm * right_P;
  plane.step_v_P = step_mm * down_P;
  plane.columns = plane.rows = pixels;
  hu_.resize(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
  if (motion_.is_rest()) {
    volume::sample_slice(patient_->ct, plane, kOutside_hu, hu_);
  } else {
    motion::rest_of_plane(motion_, plane, rest_A_);
    volume::sample_points(patient_->ct, rest_A_, kOutside_hu, hu_);
  }
  const std::span<std::uint8_t> rgba = quad.resize(pixels, pixels);
  const auto low_hu = static_cast<float>(options_.level_hu - 0.5 * options_.window_hu);
  const auto scale = static_cast<float>(255.0 / options_.window_hu);
  const auto is_body = [&](std::size_t i) {
    if (hu_[i] < 0.5F * kOutside_hu) return false;
    if (patient_->skin_distance_mm.empty()) return true;
    const auto column = static_cast<double>(i % static_cast<std::size_t>(pixels));
    const auto row = static_cast<double>(i / static_cast<std::size_t>(pixels));
    const Vec3 p_P = plane.origin_P + column * plane.step_u_P + row * plane.step_v_P;
    return volume::sample_linear(patient_->skin_distance_mm, motion_.is_rest() ? p_P : rest_A_[i].cast<double>()) <
           kBeyondSkin_mm;
  };
  for (std::size_t i = 0; i < hu_.size(); ++i) {
    const auto grey = static_cast<std::uint8_t>(std::clamp((hu_[i] - low_hu) * scale, 0.0F, 255.0F));
    rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = grey;
    rgba[4 * i + 3] = is_body(i) ? 255 : 0;
  }
  quad.show({corner_P, corner_P + options_.size_mm * right_P, corner_P + options_.size_mm * down_P});
}

}  // namespace trocar::scene::detail
