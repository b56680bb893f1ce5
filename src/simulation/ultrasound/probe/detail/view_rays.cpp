#include "ultrasound/probe/detail/view_rays.h"

#include <algorithm>
#include <cmath>

#include "ultrasound/scanner/detail/receiver.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kSubject_mm = 40.0;  ///< The subject: the target within this distance of the view's point [assumed].
constexpr double kLeaves_mm = 60.0;   ///< The subject may continue if a scanline leaves the CT this near.
constexpr double kAreaStep_mm = 3.0;
constexpr double kRayStep_mm = 2.0;
constexpr double kEdge_mm = 8.0;             ///< Gas by its HU within this distance in front of a lung's label is lung.
constexpr double kLoss_db_per_cm_mhz = 0.5;  ///< Soft tissue, one way.
constexpr double kFade_db = 10.0;            ///< Above the noise; below this an echo fades [assumed].
constexpr double kBetweenRibs = 0.2;         ///< Standard deviation of the weights, in half widths [assumed].

}  // namespace

ViewRays::ViewRays(const ViewAnatomy& ground, const ProbeView& view, const Transducer& transducer, const Vec3& target_P)
    : ground_(ground),
      scan_(make_scan_geometry(transducer, std::min(view.depth_mm, transducer.greatest_depth_mm), kLines, 16)),
      target_P_(target_P),
      is_between_ribs_(view.bone == BonePreference::kBeside),
      shows_bone_(view.bone == BonePreference::kShow) {
  const anatomy::Label* target = find_target(ground.patient, view.targets);
  if (target != nullptr) is_subject_[target->id] = true;
  if (shows_bone_)
    for (std::size_t id = 0; id < is_subject_.size(); ++id) is_subject_[id] = is_subject_[id] || ground.is_bone[id];
  is_surface_ = view.bone == BonePreference::kShow ||
                (target != nullptr && (ground.is_bone[target->id] || ground.is_lung[target->id]));
  frequency_mhz_ =
      std::clamp(view.frequency_mhz.value_or(transducer.frequency_mhz), transducer.lowest_mhz, transducer.highest_mhz);
}

ViewRays::Ray ViewRays::trace(const Pose& X_PT, int line, const Vec2& target_T) const {
  const Vec2 origin = scan_.line_origin(line), direction = scan_.line_direction(line);
  Ray ray;
  ray.end_mm = scan_.depth_mm;
  bool is_entered = false;
  for (double at_mm = 0.0; at_mm < scan_.depth_mm; at_mm += kRayStep_mm) {
    const Vec2 p_T = origin + at_mm * direction;
    const Vec3 p_P = X_PT * Vec3(p_T.x(), p_T.y(), 0.0);
    const auto stop = [&](End why) {
      if (ray.end != End::kPicture) return;
      ray.end_mm = at_mm;
      ray.end = why;
    };
    if (is_unscanned(ground_.ends, p_P)) {
      ray.has_left = (p_T - target_T).norm() < kLeaves_mm;
      stop(End::kUnscanned);
      break;
    }
    const double skin_mm = ground_.skin_mm(p_P);
    if (skin_mm > 0.0) {
      if (!is_entered) continue;
      stop(End::kGas);
      break;
    }
    is_entered = true;
    const std::uint8_t label = ground_.label_at(p_P);
    const bool is_near = shows_bone_ || (p_T - target_T).norm() < kSubject_mm;
    if (ray.subject_mm < 0.0 && is_subject_[label] && is_near) ray.subject_mm = at_mm;
    if (ray.end != End::kPicture) continue;
    if (ground_.is_bone[label]) stop(End::kBone);
    if (ground_.is_lung[label] || ground_.is_gas_at(p_P)) stop(End::kGas);
  }
  return ray;
}

double ViewRays::weight(double line) const noexcept {
  if (!is_between_ribs_) return 1.0;
  const double off = (line - scan_.middle_line()) / scan_.middle_line();
  return std::exp(-0.5 * off * off / (kBetweenRibs * kBetweenRibs));
}

double ViewRays::penetration_share(double depth_mm) const noexcept {
  const double loss_db = 2.0 * kLoss_db_per_cm_mhz * frequency_mhz_ * depth_mm / 10.0;
  return std::clamp((-kReceiverNoise_db - loss_db) / kFade_db, 0.0, 1.0);
}

/// Beyond an end of the CT, the subject is assumed to continue as its mirror image.
bool ViewRays::is_subject(const Vec3& p_P, bool& is_unscanned_there) const {
  Vec3 inside_P = p_P;
  is_unscanned_there = false;
  for (const ScanEnd& end : ground_.ends) {
    const double beyond_mm = end.normal_P.dot(inside_P) - end.offset_mm;
    if (beyond_mm <= 0.0) continue;
    is_unscanned_there = true;
    inside_P -= 2.0 * beyond_mm * end.normal_P;
  }
  return is_subject_[ground_.label_at(inside_P)];
}

ViewVisibility ViewRays::measure_area(const Pose& X_PT, const std::vector<Ray>& rays, const Vec2& target_T) const {
  ViewVisibility shares;
  double all = 0.0;
  for (double y = -kSubject_mm; y <= kSubject_mm; y += kAreaStep_mm) {
    for (double x = -kSubject_mm; x <= kSubject_mm; x += kAreaStep_mm) {
      if (std::hypot(x, y) > kSubject_mm) continue;
      const Vec2 p_T = target_T + Vec2(x, y);
      bool is_unscanned_there = false;
      if (!is_subject(X_PT * Vec3(p_T.x(), p_T.y(), 0.0), is_unscanned_there)) continue;
      const Polar at = scan_.to_polar(p_T);
      const double held = std::clamp(at.line, 0.0, static_cast<double>(kLines - 1));
      const double counted = weight(held);
      all += counted;
      const Ray& ray = rays[static_cast<std::size_t>(std::lround(held))];
      if (held != at.line || at.depth_mm < 0.0 || at.depth_mm > scan_.depth_mm) {
        shares.outside_picture += counted;
      } else if (ray.end == End::kBone && ray.end_mm < at.depth_mm) {
        shares.behind_bone += counted;
      } else if (ray.end == End::kGas && ray.end_mm < at.depth_mm) {
        shares.behind_gas += counted;
      } else if (is_unscanned_there) {
        shares.unscanned += counted;
      } else {
        shares.visible += counted * penetration_share(at.depth_mm);
        shares.too_deep += counted * (1.0 - penetration_share(at.depth_mm));
      }
    }
  }
  if (all <= 0.0) return {.outside_picture = 1.0};
  for (double* share : {&shares.visible, &shares.behind_bone, &shares.behind_gas, &shares.unscanned,
                        &shares.outside_picture, &shares.too_deep})
    *share /= all;
  return shares;
}

/// Scanlines near the target: each meets the subject, or would beyond the end of the CT.
ViewVisibility ViewRays::measure_surface(const std::vector<Ray>& rays, const Vec2& target_T) const {
  ViewVisibility shares;
  double all = 0.0;
  for (int line = 0; line < kLines; ++line) {
    const Ray& ray = rays[static_cast<std::size_t>(line)];
    const Vec2 origin = scan_.line_origin(line), direction = scan_.line_direction(line);
    const double aside_mm = direction.x() * (target_T - origin).y() - direction.y() * (target_T - origin).x();
    if (std::abs(aside_mm) > kSubject_mm) continue;
    const bool is_met = ray.subject_mm >= 0.0;
    if (!is_met && !ray.has_left) continue;
    const double counted = weight(line);
    all += counted;
    if (!is_met && ray.end == End::kUnscanned) {
      shares.unscanned += counted;
    } else if (is_met && ray.end_mm >= ray.subject_mm - kEdge_mm) {
      shares.visible += counted * penetration_share(ray.subject_mm);
      shares.too_deep += counted * (1.0 - penetration_share(ray.subject_mm));
    } else {
      (ray.end == End::kBone ? shares.behind_bone : shares.behind_gas) += counted;
    }
  }
  if (all <= 0.0) return {.outside_picture = 1.0};
  for (double* share : {&shares.visible, &shares.behind_bone, &shares.behind_gas, &shares.unscanned,
                        &shares.outside_picture, &shares.too_deep})
    *share /= all;
  return shares;
}

ViewVisibility ViewRays::measure(const Pose& X_PT) const {
  const Vec3 target_T = X_PT.inverse() * target_P_;
  const Vec2 in_plane_T(target_T.x(), target_T.y());
  std::vector<Ray> rays;
  rays.reserve(kLines);
  for (int line = 0; line < kLines; ++line) rays.push_back(trace(X_PT, line, in_plane_T));
  return is_surface_ ? measure_surface(rays, in_plane_T) : measure_area(X_PT, rays, in_plane_T);
}

}  // namespace trocar::ultrasound::detail
