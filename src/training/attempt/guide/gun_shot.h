#pragma once

#include <string>
#include <vector>

#include "cases/prepare_case.h"
#include "geometry/segment.h"
#include "tasks/core_sample.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// A stretch of the core as it is drawn.
struct ShotPiece {
  tasks::CorePart part = tasks::CorePart::kOther;
  std::string label;
  double from_mm = 0.0, to_mm = 0.0;  ///< As CorePiece.
};

/// The shot of a biopsy gun: where it went and what it took. Frame P.
struct GunShot {
  double time_s = 0.0;    ///< Of the session.
  double depth_mm = 0.0;  ///< Of the tip below the skin before the shot.
  double throw_mm = 0.0;  ///< How far the stylet got.
  Segment core_P;         ///< Position of the core.
  tasks::BiopsyCore core;
  std::vector<ShotPiece> pieces;

  bool is_in_body() const noexcept { return depth_mm > 0.0; }
};

/// The shot at a tick. Outside of the body it takes nothing.
GunShot make_gun_shot(const cases::Case& the_case, const telemetry::TickSample& fired);

/// "the gun was fired at 92 mm: a core of 17 mm, 14 mm of it target tissue".
std::string shot_words(const GunShot& shot);

/// How far stylet and cannula have moved forward (mm) so long after the shot: the stylet first, then the cannula over
/// it, slow enough to be seen. Both stay forward. The felt needle has no throw: as it is withdrawn (`depth_mm` of its
/// tip) the shown throw shrinks, so that the needle is out where it is felt to be out.
struct GunThrow {
  double stylet_mm = 0.0, cannula_mm = 0.0;
};
GunThrow throw_at(const GunShot& shot, double since_s, double depth_mm) noexcept;
inline constexpr double kStyletMoves_s = 0.2;   ///< A gun does it in some 10 ms, which nobody sees. [assumed]
inline constexpr double kCannulaMoves_s = 0.2;  ///< After the stylet. [assumed]

/// The shaft with its last point moved forward along the last stretch.
std::vector<Vec3> thrown_shaft(std::vector<Vec3> shaft_P, double forward_mm);

}  // namespace trocar::attempt
