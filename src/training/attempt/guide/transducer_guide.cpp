#include "attempt/guide/transducer_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/direction_words.h"
#include "anatomy/structure_words.h"
#include "metrics/shadow.h"

namespace trocar::attempt {
namespace {

constexpr double kContact_n = 0.05;  ///< As in scoring/phase_tracker.cpp.

}  // namespace

std::string guide_transducer(const anatomy::VirtualPatient& patient, const Vec3& target_P, const Pose& X_PT,
                             double contact_n, const metrics::ImagePlane& plane) {
  if (!X_PT.is_finite() || !target_P.allFinite()) return {};
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
    const anatomy::Label* const before = metrics::find_shadow(patient, plane, X_PT, target_P);
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
