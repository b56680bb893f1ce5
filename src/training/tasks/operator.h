#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "geometry/segment.h"
#include "tasks/action.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::tasks {

/// Input of an operator before a tick.
struct OperatorView {
  double time_s = 0.0;
  double dt_s = 0.001;
  Pose X_PN_device;                     ///< Needle as the device holds it now.
  telemetry::TickSample last;           ///< Result of the last tick; default values at the first call.
  std::optional<Return> returned = {};  ///< What came when the operator looked last; empty: not looked yet.
};

/// Target pose of the operator's hand: the hand's spring pulls the device there.
struct HandCommand {
  Pose X_PN;                            ///< Wanted needle pose.
  Vec3 v_P = Vec3::Zero();              ///< Wanted velocity of the tip, mm/s.
  std::optional<ActionRequest> action;  ///< Done at this tick.
  bool is_done = false;                 ///< Finished.
  double grip = 1.0;                    ///< Stiffness of the hand as a multiple of HandParams'; above 1: braced.
  bool is_rigid = false;                ///< The device follows X_PN exactly, independent of the force (replay).

  bool fires() const noexcept { return action && action->kind == ActionKind::kFire; }
};

/// A scripted operator. Deterministic: the same seed and the same views give the same commands.
class Operator {
 public:
  virtual ~Operator() = default;
  virtual HandCommand next(const OperatorView& view) noexcept = 0;
};

/// What an operator does besides moving the needle.
struct OperatorActions {
  bool gives_anaesthetic = false;           ///< Before the skin.
  std::optional<ActionKind> confirms;       ///< At the target: kDrawStylet or kAspirate.
  Substance awaited = Substance::kNothing;  ///< What comes then in the right place.
  double wire_mm = 0.0;                     ///< Guide wire advanced at the target; 0: none.
  std::size_t cores = 1;                    ///< Shots of a biopsy gun.
  /// The gun is loaded through a coaxial needle that stays at the target; false: each further core is another puncture.
  bool loads_inside = false;
};
/// Those that the task's phases and score ask for.
OperatorActions actions_for(const Task& task, const Needle& needle);

/// Fat under the skin over the landmarks by which an entry is found, which hides them from the fingers: along the
/// planned path. 0: the entry is found in images.
double landmark_cover_mm(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P);

/// Case data for an operator.
struct OperatorCase {
  Segment path_P;             ///< The planned (expert) path: entry on the skin -> end position of the tip.
  bool fires_biopsy = false;  ///< The gun is fired at the end position.
  std::uint64_t seed = 1;
  OperatorActions actions = {};
  std::optional<Vec3> bevel_P = {};  ///< Direction that the bevel has to face; empty: any.
  double cover_mm = 0.0;             ///< See landmark_cover_mm.
  double tremor_mm = 0.0;            ///< Added to the operator's own tremor, rms of each lateral axis. Range 0..3.
  /// Of a novice: share of all errors, 0 (none) .. 1 (all). Empty: all, but of the errors of entry, angle and depth a
  /// share drawn from the seed.
  std::optional<double> error_share = {};
};

/// Follows the path: touches, pauses, inserts more slowly with more resistance, stops when the (virtual) tip is at the
/// target, holds still, looks what comes back and presses on where a wall has not given way yet; or fires, loads the
/// gun and fires again until all cores are taken, withdraws. Stops without firing if it cannot advance. The device must
/// start at the pose of the first command. Takes about 10..30 s, at most 60.
std::unique_ptr<Operator> make_expert(const OperatorCase& the_case);
/// Misses the entry and the angle, trembles, moves unevenly and too fast, hesitates, pulls back, looks what comes back
/// every few millimetres or stops short or too deep; withdraws from bone and from where nothing comes, and tries again
/// with smaller errors (twice at most): at random, from the seed. The same seed with a smaller error_share misses
/// entry, angle and depth in the same direction by less. Never more than 60 s.
std::unique_ptr<Operator> make_novice(const OperatorCase& the_case);
/// Rigid: the device moves at the given speed, independent of forces, so that forces can be compared with closed forms.
/// It moves from 10 mm before the entry to the target, fires there if the case does, and moves out again. speed in
/// mm/s, 0.1..500.
std::unique_ptr<Operator> make_constant_velocity(const OperatorCase& the_case, double speed_mm_per_s);
/// The device poses of a recorded session, tick by tick, rigid, and its actions, each at its tick.
std::unique_ptr<Operator> make_replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions = {});

}  // namespace trocar::tasks
