#include "attempt/guide/gun_shot.h"

#include <fmt/format.h>

#include <algorithm>

#include "telemetry/tick_pose.h"

namespace trocar::attempt {

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
