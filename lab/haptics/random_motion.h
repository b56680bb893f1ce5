#pragma once

#include <array>
#include <optional>

#include "core/random.h"
#include "lab/haptics/closed_motion.h"
#include "lab/haptics/passivity_trial.h"

namespace trocar::haptics {

/// Kinds of closed motions of a hand (physics.md H8). The elastic ones puncture nothing and cut nothing.
enum class MotionKind {
  kDrag,            ///< Pressed on closed skin, moved along it, lifted, moved back.
  kSlide,           ///< Several ways along closed skin under varying load, with rotations.
  kTap,             ///< Pushes on closed skin.
  kPuncture,        ///< In, a pause, out.
  kGiveWay,         ///< In until the skin gives way, held or moved by little, out.
  kReentry,         ///< Twice in, beside or into the same channel.
  kBend,            ///< Moved sideways deep in the body.
  kTurn,            ///< Rotated deep in the body, about tip, grip or axis.
  kScrew,           ///< Moved sideways and rotated while it goes in and out.
  kSpline,          ///< A smooth curve through random poses in and outside the body.
  kElasticSkin,     ///< On skin that never opens.
  kElasticChannel,  ///< In a channel that was cut before, no deeper.
  kElasticWall,     ///< The same, to layers that never open.
};
inline constexpr std::array kNeedleKinds{
    MotionKind::kDrag,    MotionKind::kSlide, MotionKind::kTap,  MotionKind::kPuncture, MotionKind::kGiveWay,
    MotionKind::kReentry, MotionKind::kBend,  MotionKind::kTurn, MotionKind::kScrew,    MotionKind::kSpline};
inline constexpr std::array kFaceKinds{MotionKind::kDrag, MotionKind::kSlide, MotionKind::kTap, MotionKind::kSpline};
inline constexpr std::array kElasticKinds{MotionKind::kElasticSkin, MotionKind::kElasticChannel,
                                          MotionKind::kElasticWall};
const char* to_string(MotionKind kind) noexcept;
bool is_elastic(MotionKind kind) noexcept;

/// A place on the skin and a tool over it. Frame P.
struct MotionPlace {
  Vec3 skin_P = Vec3::Zero();
  Vec3 inward_P = Vec3::UnitZ();  ///< Unit.
  Vec3 axis_P = Vec3::UnitZ();    ///< Unit: the tool's axis; 0 to 80 degrees to `inward_P`.
  double length_mm = 150.0;       ///< From the tip to the stylus origin S.
  double closed_mm = 10.0;        ///< Way along the axis on which the skin stays closed.
  double deepest_mm = 60.0;       ///< Deepest way along the axis.
  double tempo_mm_per_s = 50.0;   ///< 1 to 330.
  double widest_rad = 0.35;       ///< Largest rotation.
};

/// The motion that prepares the channel of the elastic kinds; empty for the others.
std::optional<ClosedMotion> motion_before(MotionKind kind, const MotionPlace& place);

/// A random closed motion of this kind. It begins and ends free of contact, 15 mm above the skin.
ClosedMotion make_random_motion(MotionKind kind, const MotionPlace& place, Random& random);

}  // namespace trocar::haptics
