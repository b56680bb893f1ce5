#include "attempt/guide/puncture_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/structure_words.h"
#include "geometry/pose.h"
#include "metrics/metric.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

constexpr double kFarFromEntry_mm = 15.0;
constexpr double kLookStep_mm = 0.5;

/// Distance ahead of the tip that the needle, or the stylet of its gun, still has to go.
double still_to_go_mm(const cases::Case& the_case, const telemetry::TickSample& sample) {
  const Segment& path_P = the_case.plan.line_P;
  const Vec3 to_target = path_P.b - sample.rest_tip_mm;
  const double left_mm = to_target.dot(sample.rest_axis);
  const bool is_aimed = (to_target - left_mm * sample.rest_axis).norm() <= the_case.task.target_tolerance_mm;
  if (!is_aimed) return kGuideAhead_mm;
  const double throw_mm = the_case.needle.is_biopsy ? the_case.needle.throw_mm : 0.0;
  if (left_mm > kGuideAhead_mm) return kGuideAhead_mm;
  return std::max(0.0, left_mm) + (left_mm <= kGuideDepth_mm ? throw_mm : 0.0);
}

/// What the tip is in, or will harm.
std::string danger_ahead(const cases::Case& the_case, const telemetry::TickSample& sample) {
  const double far_mm = still_to_go_mm(the_case, sample);
  const Vec3 tip_P = telemetry::pierced_rest_tip_mm(sample);
  for (double ahead_mm = 0.0; ahead_mm <= far_mm; ahead_mm += kLookStep_mm) {
    const Vec3 from_P = ahead_mm > 0.0 ? sample.rest_tip_mm : tip_P;
    const anatomy::Label* label = anatomy::find_label(*the_case.patient, from_P + ahead_mm * sample.rest_axis);
    if (label == nullptr) continue;
    const bool is_bone = label->tissue == "bone";
    if (!is_bone && find_harm(the_case.task, *label).grade == tasks::Harm::kNone) continue;
    const std::string name = anatomy::structure_words(label->name);
    if (ahead_mm == 0.0) return fmt::format("The tip is in the {}: pull back", name);
    return fmt::format("{} {:.0f} mm ahead: stop, {}", is_bone ? "Bone" : name, std::ceil(ahead_mm),
                       sample.depth_mm > 0.0 ? "pull back and tilt" : "aim anew");
  }
  return {};
}

std::string guide_outside(const Segment& path_P, const telemetry::TickSample& sample) {
  const Vec3 to_entry = path_P.a - sample.rest_tip_mm;
  const Vec3 axis = path_P.direction();
  const Vec3 across = to_entry - to_entry.dot(axis) * axis;
  if (across.norm() > kFarFromEntry_mm) return "The entry is " + anatomy::direction_words(across, " mm");
  if (across.norm() > kGuideBeside_mm)
    return fmt::format("{:.1f} mm from the entry: move the tip {}", across.norm(), anatomy::direction_words(across));
  const double angle_deg = kDegPerRad * angle_between_rad(sample.rest_axis, axis);
  if (angle_deg > kGuideTilt_deg)
    return fmt::format("{:.0f} degrees off the path: tilt the hub {}", angle_deg,
                       anatomy::direction_words(sample.rest_axis - axis));
  return "On the path: advance";
}

bool is_in_target(const cases::Case& the_case, const Vec3& p_P) {
  const anatomy::Label* const label = anatomy::find_label(*the_case.patient, p_P);
  return label != nullptr && is_target(the_case.task, *label);
}

/// The target is a place, not a structure.
bool is_place(const cases::Case& the_case) noexcept {
  return the_case.is_parenchymal || the_case.task.target_P.has_value();
}

std::string at_target_words(const cases::Case& the_case) {
  if (the_case.needle.is_biopsy) return "At the target: hold still and fire";
  if (the_case.task.confirmed_by == tasks::Substance::kNothing) return "At the target: hold still";
  return the_case.needle.stylet_diameter_mm > 0.0 ? "At the target: hold still and remove the stylet"
                                                  : "At the target: hold still and aspirate";
}

/// Near the planned place, but not in the target structure.
std::string beside_target(const cases::Case& the_case, const telemetry::TickSample& sample, const Vec3& across) {
  const std::string name = anatomy::structure_words(
      the_case.task.target_tissues.empty() ? the_case.task.organ : the_case.task.target_tissues.front());
  if (is_in_target(the_case, sample.rest_tip_mm)) return "On the wall of the " + name + ": press on until it gives way";
  if (across.norm() < 0.5) return "Beside the " + name + ": advance or pull back by a millimetre";
  return fmt::format("Beside the {}: pull back a little and tilt the tip {}", name, anatomy::direction_words(across));
}

std::string guide_inside(const cases::Case& the_case, const telemetry::TickSample& sample) {
  const Segment& path_P = the_case.plan.line_P;
  const Vec3 axis = path_P.direction();
  const Vec3 to_target = path_P.b - sample.rest_tip_mm;
  const double left_mm = to_target.dot(axis);
  const Vec3 across = to_target - left_mm * axis;
  const double beside_mm = across.norm();
  const bool is_near = std::abs(left_mm) <= kGuideDepth_mm && beside_mm <= the_case.task.target_tolerance_mm;
  const bool is_structure = !is_place(the_case) && !the_case.needle.is_biopsy;
  if (is_structure && is_in_target(the_case, telemetry::pierced_rest_tip_mm(sample))) return at_target_words(the_case);
  if (is_near) return is_structure ? beside_target(the_case, sample, across) : at_target_words(the_case);
  if (left_mm < -kGuideDepth_mm) return fmt::format("{:.1f} mm too deep: pull back", -left_mm);
  if (beside_mm > kGuideBeside_mm) {
    const double turn_deg = kDegPerRad * angle_between_rad(sample.rest_axis, to_target);
    return fmt::format("{:.1f} mm from the path: tilt the tip {} by {:.0f} degrees", beside_mm,
                       anatomy::direction_words(across), std::min(turn_deg, 90.0));
  }
  return fmt::format("{:.0f} mm to the target", left_mm);
}

/// What the last shot brought.
std::string shot_result(const GuideState& state) {
  const GunShot* const shot = state.last_shot;
  if (shot == nullptr || !shot->pieces.empty()) return "The core is taken";
  return shot->is_in_body() ? "No core, the stylet hit bone" : "No core, the gun was fired outside the body";
}

std::string guide_after_shot(const cases::Case& the_case, const telemetry::TickSample& sample,
                             const GuideState& state) {
  const bool is_outside = !telemetry::is_in_body(sample);
  const bool needs_more = state.cores < the_case.task.cores;
  if (needs_more && (is_outside || the_case.needle.is_coaxial))
    return shot_result(state) + ": load the gun for the next one";
  if (needs_more) return shot_result(state) + ": withdraw the needle, then load the gun";
  return is_outside ? "The needle is out: end the attempt" : "The gun was fired: withdraw the needle";
}

/// Once everything that the puncture was for has been done; empty: it has not.
std::string guide_to_end(const cases::Case& the_case, const telemetry::TickSample& sample, const GuideState& state) {
  const bool is_outside = !telemetry::is_in_body(sample);
  const bool has_cores = the_case.needle.is_biopsy && state.cores >= the_case.task.cores;
  const bool is_proven = !the_case.needle.is_biopsy && state.is_confirmed;
  if (is_outside && (state.are_steps_done || has_cores || is_proven)) return "The needle is out: end the attempt";
  if (state.are_steps_done || has_cores) return "Everything is done: withdraw the needle";
  return is_proven ? "Position confirmed: hold still for the next step" : "";
}

}  // namespace

std::string guide_puncture(const cases::Case& the_case, const telemetry::TickSample& sample, const GuideState& state) {
  if (!sample.rest_tip_mm.allFinite() || !(std::abs(sample.rest_axis.norm() - 1.0) < 1e-3)) return {};
  if (!state.is_loaded) return guide_after_shot(the_case, sample, state);
  if (std::string end = guide_to_end(the_case, sample, state); !end.empty()) return end;
  if (std::string danger = danger_ahead(the_case, sample); !danger.empty()) return danger;
  return telemetry::is_in_body(sample) ? guide_inside(the_case, sample) : guide_outside(the_case.plan.line_P, sample);
}

namespace {

constexpr double kContact_n = 0.05;  ///< As in scoring/phase_tracker.cpp.

}  // namespace

std::string guide_transducer(const anatomy::VirtualPatient& patient, const motion::PatientMotion& motion,
                             const Vec3& target_A, const Pose& X_PT, double contact_n,
                             const metrics::ImagePlane& plane) {
  if (!X_PT.is_finite() || !target_A.allFinite()) return {};
  const Vec3 target_P = motion.to_now(target_A);
  if (!(contact_n >= kContact_n)) return "The transducer does not touch the skin: press it on";
  const Vec3 target_T = X_PT.inverse() * target_P;
  if (kDegPerRad * std::atan2(std::hypot(target_T.x(), target_T.z()), target_T.y()) > kGuideSteep_deg) {
    const Vec3 aside_P = X_PT.R() * Vec3(target_T.x(), 0.0, target_T.z());
    return fmt::format("The target is {}: move the transducer there", anatomy::direction_words(aside_P, " mm"));
  }
  if (std::abs(target_T.z()) > kGuideBesidePlane_mm) {
    const Vec3 aside_P = target_T.z() * X_PT.R().col(2);
    return fmt::format("The image passes {:.0f} mm beside the target: move or tilt it {}", std::abs(target_T.z()),
                       anatomy::direction_words(aside_P));
  }
  if (plane.is_in_field(target_T)) {
    const anatomy::Label* const before = metrics::find_shadow(patient, motion, plane, X_PT, target_P);
    if (before == nullptr) return "The target is in the image: hold still";
    return fmt::format("The {} hides the target: look beside it", anatomy::structure_words(before->name));
  }
  Vec3 raised_T = target_T;
  raised_T.y() = std::min(target_T.y(), 0.9 * plane.depth_mm);
  if (plane.is_in_field(raised_T)) return "The target lies below the image: increase the depth";
  return "The target is beside the image: move the transducer " +
         anatomy::direction_words(Vec3(target_T.x() * X_PT.R().col(0)));
}

bool is_step_of_transducer(const tasks::Phase& phase) {
  return std::any_of(phase.done.begin(), phase.done.end(), [](const tasks::Condition& condition) {
    return condition.kind == tasks::ConditionKind::kProbeOnSkin ||
           condition.kind == tasks::ConditionKind::kTargetInImage;
  });
}

}  // namespace trocar::attempt
