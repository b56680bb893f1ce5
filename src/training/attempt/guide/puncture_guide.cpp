#include "attempt/guide/puncture_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/direction_words.h"
#include "anatomy/structure_words.h"
#include "geometry/pose.h"

namespace trocar::attempt {
namespace {

constexpr double kFarFromEntry_mm = 15.0;
constexpr double kLookStep_mm = 0.5;

/// Structures at risk ahead of the tip.
std::string danger_ahead(const cases::Case& the_case, const telemetry::TickSample& sample) {
  for (double ahead_mm = 0.0; ahead_mm <= kGuideAhead_mm; ahead_mm += kLookStep_mm) {
    const anatomy::Label* label = anatomy::find_label(*the_case.patient, sample.tip_mm + ahead_mm * sample.axis);
    if (label == nullptr) continue;
    const bool is_bone = label->tissue == "bone";
    if (!is_bone && find_risk(the_case.task, *label) == nullptr) continue;
    if (ahead_mm == 0.0) return fmt::format("The tip is in the {}: pull back", anatomy::structure_words(label->name));
    return fmt::format("{} {:.0f} mm ahead: stop, {}", is_bone ? "Bone" : anatomy::structure_words(label->name),
                       std::ceil(ahead_mm), sample.depth_mm > 0.0 ? "pull back and tilt" : "aim anew");
  }
  return {};
}

std::string guide_outside(const Segment& path_P, const telemetry::TickSample& sample) {
  const Vec3 to_entry = path_P.a - sample.tip_mm;
  const Vec3 axis = path_P.direction();
  const Vec3 across = to_entry - to_entry.dot(axis) * axis;
  if (across.norm() > kFarFromEntry_mm) return "The entry is " + anatomy::direction_words(across, " mm");
  if (across.norm() > kGuideBeside_mm)
    return fmt::format("{:.1f} mm from the entry: move the tip {}", across.norm(), anatomy::direction_words(across));
  const double angle_deg = kDegPerRad * angle_between_rad(sample.axis, axis);
  if (angle_deg > kGuideTilt_deg)
    return fmt::format("{:.0f} degrees off the path: tilt the hub {}", angle_deg,
                       anatomy::direction_words(sample.axis - axis));
  return "On the path: advance";
}

std::string guide_inside(const cases::Case& the_case, const telemetry::TickSample& sample) {
  const Segment& path_P = the_case.plan.line_P;
  const Vec3 axis = path_P.direction();
  const Vec3 to_target = path_P.b - sample.tip_mm;
  const double left_mm = to_target.dot(axis);
  if (left_mm < -kGuideDepth_mm) return fmt::format("{:.1f} mm too deep: pull back", -left_mm);
  const Vec3 across = to_target - left_mm * axis;
  const double beside_mm = across.norm();
  if (std::abs(left_mm) <= kGuideDepth_mm && beside_mm <= the_case.task.target_tolerance_mm)
    return the_case.needle.is_biopsy ? "At the target: hold still and fire" : "At the target: hold still";
  if (beside_mm > kGuideBeside_mm) {
    const double turn_deg = kDegPerRad * angle_between_rad(sample.axis, to_target);
    return fmt::format("{:.1f} mm from the path: tilt the tip {} by {:.0f} degrees", beside_mm,
                       anatomy::direction_words(across), std::min(turn_deg, 90.0));
  }
  return fmt::format("{:.0f} mm to the target", left_mm);
}

std::string guide_after_shot(const cases::Case& the_case, const telemetry::TickSample& sample, const GunState& gun) {
  const bool is_outside = sample.phase == telemetry::InsertionPhase::kOutside;
  const bool needs_more = gun.shots < the_case.task.cores;
  if (needs_more && (is_outside || the_case.needle.is_coaxial))
    return "The core is taken: load the gun for the next one";
  if (needs_more) return "The core is taken: withdraw the needle, then load the gun";
  return is_outside ? "The needle is out: end the attempt" : "The gun was fired: withdraw the needle";
}

}  // namespace

std::string guide_puncture(const cases::Case& the_case, const telemetry::TickSample& sample, const GunState& gun) {
  if (!sample.tip_mm.allFinite() || !(std::abs(sample.axis.norm() - 1.0) < 1e-3)) return {};
  if (!gun.is_loaded) return guide_after_shot(the_case, sample, gun);
  std::string danger = danger_ahead(the_case, sample);
  if (!danger.empty()) return danger;
  const bool is_inside = sample.phase == telemetry::InsertionPhase::kInserted ||
                         sample.phase == telemetry::InsertionPhase::kRetracting ||
                         sample.depth_mm > the_case.tissues.skin_thickness_mm;
  return is_inside ? guide_inside(the_case, sample) : guide_outside(the_case.plan.line_P, sample);
}

}  // namespace trocar::attempt
