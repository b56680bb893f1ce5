#pragma once

#include <memory>
#include <string_view>

#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/segment.h"
#include "telemetry/tick_sample.h"

namespace trocar {

/// What an operator knows before a tick.
struct OperatorView {
  double time_s = 0.0;
  double dt_s = 0.001;
  Pose X_PN_device;  ///< Needle as the device holds it now.
  TickSample last;   ///< What the last tick made; the first time default values.
};

/// Where the operator wants its hand: the hand's spring pulls the device there.
struct HandCommand {
  Pose X_PN;                ///< Wanted needle pose.
  Vec3 v_P = Vec3::Zero();  ///< Wanted velocity of the tip, mm/s.
  bool has_fired = false;   ///< The biopsy gun is fired at this tick.
  bool is_done = false;     ///< Nothing more to do.
  bool is_rigid = false;    ///< The device follows X_PN exactly, whatever it pushes (replay).
};

/// A scripted operator. Deterministic: the same seed and the same views give the same commands.
class Operator {
 public:
  virtual ~Operator() = default;
  virtual HandCommand next(const OperatorView& view) noexcept = 0;
};

/// What an operator needs to know of the case.
struct OperatorCase {
  Segment path_P;  ///< The planned (expert) path, entry -> target.
  bool fires_biopsy = false;
  double throw_mm = 0.0;  ///< The tip stops this far before the lesion's far side needs it.
  std::uint64_t seed = 1;
};

std::unique_ptr<Operator> make_expert(const OperatorCase& the_case);
std::unique_ptr<Operator> make_novice(const OperatorCase& the_case);
/// Along the path at a constant speed to the target, then out again. speed in mm/s, 0.1..500.
std::unique_ptr<Operator> make_constant_velocity(const OperatorCase& the_case, double speed_mm_per_s);
/// The device poses of a recorded session, tick by tick.
std::unique_ptr<Operator> make_replay(std::vector<TickSample> samples);

}  // namespace trocar
