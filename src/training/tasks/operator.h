#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "geometry/shapes.h"
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
  bool holds_breath = false;  ///< The patient breathes, and is asked to hold the breath while the needle is inside.
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

/// Asks the patient to hold the breath and waits for it, follows the path: touches, pauses, inserts more slowly with
/// more resistance, stops when the (virtual) tip is at the target, holds still, looks what comes back and presses on
/// where a wall has not given way yet; or fires, loads the gun and fires again until all cores are taken, withdraws.
/// Stops without firing if it cannot advance. The device must start at the pose of the first command. Takes
/// about 10..30 s, at most 60.
std::unique_ptr<Operator> make_expert(const OperatorCase& the_case);
/// May forget to ask the patient to hold the breath, or not wait until it is held; misses the entry and the angle,
/// trembles, moves unevenly and too fast, hesitates, pulls back, looks what comes back every few millimetres or stops
/// short or too deep; withdraws from bone and from where nothing comes, and tries again with smaller errors (twice at
/// most): at random, from the seed. The same seed with a smaller error_share misses entry, angle and depth in the same
/// direction by less. Never more than 60 s.
std::unique_ptr<Operator> make_novice(const OperatorCase& the_case);
/// Rigid: the device moves at the given speed, independent of forces, so that forces can be compared with closed forms.
/// It moves from 10 mm before the entry to the target, fires there if the case does, and moves out again. speed in
/// mm/s, 0.1..500.
std::unique_ptr<Operator> make_constant_velocity(const OperatorCase& the_case, double speed_mm_per_s);
/// The device poses of a recorded session, tick by tick, rigid, and its actions, each at its tick.
std::unique_ptr<Operator> make_replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions = {});

/// The hand that holds the stylus: a second-order lump (mass, spring, damper) between the operator's wanted needle
/// position and the device's needle position; docs/physics.md, hand. Form: Speich, Shao, Goldfarb 2005, Mechatronics
/// 15:1127 (the usual model of a human on a haptic handle is a second order mass-spring-damper; more elements gain
/// little in some cases). Stiffness and damping grow with the grip: Hasser, Cutkosky 2002; stylus grips of 1..3 N on a
/// Phantom Premium 1.5: Fu, Cavusoglu 2012. The numbers here are [assumed]: no table of these papers could be read. A
/// hand with a firmer grip (HandCommand::grip) has the same damping ratio.
struct HandParams {
  double mass_kg = 0.15;             ///< Mass of hand and fingers that moves with the stylus. Range 0.02..2. Assumed.
  double stiffness_n_per_mm = 0.6;   ///< Range 0.05..5. Assumed: 2.8 N at the skin press the grip in by 4.7 mm.
  double damping_ns_per_mm = 0.012;  ///< Range 0.0005..0.1. Assumed: damping ratio 0.63 of the hand alone.
  double turning_time_constant_s = 0.08;  ///< The stylus follows the wanted orientation. Range 0.005..1. Assumed.
};

/// The hand in the form for an integrator: f_P = stiffness*(anchor - tip) + damping*(anchor velocity - velocity) on a
/// mass that is added to the device's. The derivatives by position and velocity are -stiffness and -damping.
struct HandSpring {
  Vec3 anchor_P = Vec3::Zero();           ///< Target position of the tip, mm.
  Vec3 anchor_velocity_P = Vec3::Zero();  ///< mm/s.
  double stiffness_n_per_mm = 0.0;
  double damping_ns_per_mm = 0.0;
  double mass_kg = 0.0;
};
HandSpring hand_spring(const HandParams& hand, const HandCommand& command) noexcept;

/// Orientation of the device's needle dt_s later: R_PN turned towards R_PN_wanted the shortest way, the remaining angle
/// shrinks by exp(-dt/time constant) for any step. Real-time safe.
Mat3 follow_rotation(const HandParams& hand, const Mat3& R_PN, const Mat3& R_PN_wanted, double dt_s) noexcept;

}  // namespace trocar::tasks
