#include "attempt/guide/needle_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "anatomy/structure_words.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

NeedleView needle_view(const cases::Case& the_case, const telemetry::TickSample& sample,
                       const telemetry::NeedleShape& shape, const Pose& X_PN_goal) {
  NeedleView view;
  view.is_known = true;
  view.time_s = sample.time_s;
  view.X_PN = telemetry::felt_needle(sample);
  view.shaft_P = needle_shaft(sample, shape, the_case.needle.length_mm);
  view.X_PN_goal = X_PN_goal;
  view.resistance_n = telemetry::axial_resistance_n(sample);
  view.lag_mm = (X_PN_goal.p() - sample.tip_mm).dot(view.X_PN.R().col(2));
  view.depth_mm = sample.depth_mm;
  view.speed_mm_s = sample.axial_velocity_mm_s;
  view.phase = sample.phase;
  if (sample.tissue == 0 || sample.tissue >= the_case.tissues.tissues.size()) return view;
  const anatomy::Label* label = sample.tissue == the_case.tissues.skin
                                    ? nullptr
                                    : anatomy::find_label(*the_case.patient, telemetry::pierced_rest_tip_mm(sample));
  view.tissue = anatomy::structure_words(label != nullptr ? label->name : the_case.tissues.tissues[sample.tissue].name);
  return view;
}

std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, const telemetry::NeedleShape& shape,
                               double length_mm) {
  std::vector<Vec3> points_P = telemetry::shaft_points(shape, telemetry::device_pose(sample), length_mm);
  const Vec3 lag_P = sample.tip_mm - points_P.back();
  for (Vec3& point_P : points_P) point_P += lag_P;
  points_P.back() = sample.tip_mm;
  return points_P;
}

std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm) {
  if (!(inside_mm > 0.0)) return shaft_P;
  while (shaft_P.size() >= 2) {
    const Vec3 tip_P = shaft_P.back();
    shaft_P.pop_back();
    const Vec3 piece_P = tip_P - shaft_P.back();
    const double length_mm = piece_P.norm();
    if (inside_mm < length_mm) {
      shaft_P.push_back(tip_P - inside_mm / length_mm * piece_P);
      return shaft_P;
    }
    inside_mm -= length_mm;
  }
  return {};
}

GunShot make_gun_shot(const cases::Case& the_case, const telemetry::TickSample& fired) {
  const tasks::Needle& needle = the_case.needle;
  const anatomy::VirtualPatient& patient = *the_case.patient;
  GunShot shot;
  shot.time_s = fired.time_s;
  shot.depth_mm = telemetry::is_in_body(fired) ? fired.depth_mm : 0.0;
  shot.throw_mm = needle.throw_mm;
  if (shot.is_in_body()) {
    shot.throw_mm = scoring::stylet_throw_mm(the_case.task, patient, needle, fired.rest_tip_mm, fired.rest_axis);
    shot.core = scoring::take_core(the_case.task, patient, needle, fired.rest_tip_mm, fired.rest_axis);
    for (const scoring::CorePiece& piece : shot.core.pieces)
      shot.pieces.push_back({part_of(the_case.task, patient, piece), piece.label, piece.from_mm, piece.to_mm});
  }
  const double end_mm = std::max(0.0, shot.throw_mm - needle.dead_space_mm);
  const double begin_mm = std::max(0.0, end_mm - needle.notch_mm);
  shot.core_P = {fired.tip_mm + begin_mm * fired.axis, fired.tip_mm + end_mm * fired.axis};
  return shot;
}

std::string shot_words(const GunShot& shot) {
  if (!shot.is_in_body()) return "the gun was fired outside the body: no core";
  if (shot.pieces.empty()) return fmt::format("the gun was fired at {:.0f}\u00a0mm: no core, bone", shot.depth_mm);
  return fmt::format(
      "the gun was fired at {:.0f}\u00a0mm: a core of {:.0f}\u00a0mm, {:.0f}\u00a0mm of it target tissue",
      shot.depth_mm, shot.pieces.back().to_mm, shot.core.target_mm);
}

GunThrow throw_at(const GunShot& shot, double since_s, double depth_mm) noexcept {
  const auto share = [](double part, double whole) { return std::clamp(part / whole, 0.0, 1.0); };
  const double throw_mm = shot.is_in_body() ? shot.throw_mm * share(depth_mm, shot.depth_mm) : 0.0;
  return {throw_mm * share(since_s, kStyletMoves_s), throw_mm * share(since_s - kStyletMoves_s, kCannulaMoves_s)};
}

std::vector<Vec3> thrown_shaft(std::vector<Vec3> shaft_P, double forward_mm) {
  if (shaft_P.size() < 2 || !(forward_mm > 0.0)) return shaft_P;
  const Vec3 along_P = (shaft_P.back() - shaft_P[shaft_P.size() - 2]).normalized();
  shaft_P.push_back(shaft_P.back() + forward_mm * along_P);
  return shaft_P;
}

}  // namespace trocar::attempt
