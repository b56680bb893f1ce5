#pragma once

#include <string>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "cases/prepare_case.h"
#include "geometry/shapes.h"
#include "scoring/core_sample.h"
#include "telemetry/needle_shape.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Display data of a needle tick. `shape`: the newest one. `X_PN_goal`: target pose of the hand.
NeedleView needle_view(const cases::Case& the_case, const telemetry::TickSample& sample,
                       const telemetry::NeedleShape& shape, const Pose& X_PN_goal);

/// Points of the shaft in P, hub first, tip last; two points for a straight shaft. The shape of the haptic tick on the
/// pose of the device's needle, moved so that its tip is the tick's: behind the device by the lag of the felt tip.
std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, const telemetry::NeedleShape& shape,
                               double length_mm);

/// Returns the shaft without its last `inside_mm`, the part in the body. Empty if the whole shaft is in the body.
std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm);

/// A displayed piece of the core.
struct ShotPiece {
  scoring::CorePart part = scoring::CorePart::kOther;
  std::string label;
  double from_mm = 0.0, to_mm = 0.0;  ///< Distances as in CorePiece.
};

/// Shot of a biopsy gun: path of the stylet and the taken core. Frame P.
struct GunShot {
  double time_s = 0.0;    ///< Session time.
  double depth_mm = 0.0;  ///< Depth of the tip in the body before the shot; 0: the skin was not pierced.
  double throw_mm = 0.0;  ///< Distance that the stylet moved.
  Segment core_P;         ///< Position of the core.
  scoring::BiopsyCore core;
  std::vector<ShotPiece> pieces;

  bool is_in_body() const noexcept { return depth_mm > 0.0; }
};

/// Computes the shot at a tick. Outside the body the core is empty.
GunShot make_gun_shot(const cases::Case& the_case, const telemetry::TickSample& fired);

/// Description: "the gun was fired at 92 mm: a core of 17 mm, 14 mm of it target tissue".
std::string shot_words(const GunShot& shot);

/// Displayed forward displacements (mm) of stylet and cannula `since_s` after the shot. The stylet moves first, then
/// the cannula moves over it, slowly enough to be visible. Both stay forward. The felt needle has no throw: while it is
/// withdrawn (`depth_mm`: depth of its tip) the displayed throw shrinks, so that the displayed needle leaves the body
/// together with the felt needle.
struct GunThrow {
  double stylet_mm = 0.0, cannula_mm = 0.0;
};
GunThrow throw_at(const GunShot& shot, double since_s, double depth_mm) noexcept;
/// Duration of the stylet's motion; some 10 ms in a real gun, too short to be visible. [assumed]
inline constexpr double kStyletMoves_s = 0.2;
inline constexpr double kCannulaMoves_s = 0.2;  ///< Duration of the cannula's motion, after the stylet's. [assumed]

/// Returns the shaft with its last point moved forward along the last segment.
std::vector<Vec3> thrown_shaft(std::vector<Vec3> shaft_P, double forward_mm);

}  // namespace trocar::attempt
