#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "haptics/gate/safety_gate.h"
#include "server/detail/pose_hold.h"
#include "stylus/device_preset.h"

namespace trocar::server {

/// Reason why a weighing gave no weight.
enum class WeighRefusal : std::uint8_t {
  kNone,
  kNoForce,          ///< The device has no motors.
  kCarriedByDevice,  ///< The preset's weight is 0: the vendor's library carries the device.
  kForcesOff,        ///< The device did not accept a wrench.
  kFault,            ///< The gate's fault.
  kNotAtRest,        ///< The stylus did not come to rest in time.
  kMoved,            ///< The stylus was moved far from its place.
  kHeld,             ///< It did not follow: a hand or the holder holds it.
  kUnsteady,         ///< The force was not constant along the way.
  kTooHeavy,         ///< Heavier than the device can hold for long.
  kPullsUp,          ///< The arm pulls upwards.
};

/// Result of a weighing. Forces in D, +z up. Fixed size.
struct WeighResult {
  WeighRefusal refusal = WeighRefusal::kNone;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  double weight_n = 0.0;      ///< Mean of the vertical force upwards and downwards. Range 0..limit_n.
  double friction_n = 0.0;    ///< Half of their difference.
  double horizontal_n = 0.0;  ///< Horizontal force: a tilted base, or a cable that pulls.
  double spread_n = 0.0;      ///< Largest deviation of a second's mean from the mean of its direction.
  /// Centre of the weight behind S, along -z of S. Absent without torque, or if the stylus is nearly vertical.
  std::optional<double> lever_mm;
  double limit_n = 0.0;  ///< The heaviest weight that the device can hold for long.
};

/// Weighs the stylus of a device by the force that holds it (physics.md W2): waits until it rests, raises and lowers it
/// twice by kWay_mm, and averages the written force while it slides, so that dry and viscous friction cancel. Gives a
/// wrench for the gate; never writes to a device. Time is an argument; real-time safe.
class StylusWeighing {
 public:
  static constexpr double kWay_mm = 8.0;
  static constexpr double kLeg_s = 4.0;   ///< Time of one way up or down.
  static constexpr double kMean_s = 2.0;  ///< Averaged at its end; before, the friction changes its direction.

  struct Input {
    std::optional<Pose> X_DS;                              ///< A fresh reading.
    Wrench written_D;                                      ///< Output of the gate in the last period.
    telemetry::GateMode mode = telemetry::GateMode::kOff;  ///< Of the gate in the last period.
    double dt_s = 0.001;
  };
  struct Demand {
    Wrench wanted_D, weight_D;  ///< weight_D: the preset's; conservative.
    bool is_wanted = false;
  };

  StylusWeighing(const stylus::DevicePreset& preset, const haptics::GateParams& gate) noexcept;

  /// Starts; a device that cannot be weighed is refused at once.
  void start() noexcept;
  Demand step(const Input& input) noexcept;
  void abort(WeighRefusal refusal, telemetry::GateFault fault) noexcept;
  bool is_running() const noexcept { return phase_ != Phase::kIdle; }
  /// A hand must still hold the stylus; it lets go when this becomes false.
  bool needs_hand() const noexcept;
  /// Result of a weighing that has ended, once.
  std::optional<WeighResult> take_result() noexcept;
  /// Spring and damper of the hold, for the gate.
  stylus::CouplingParams coupling() const noexcept;

 private:
  enum class Phase : std::uint8_t { kIdle, kClearing, kRising, kSettling, kMoving };
  static constexpr int kLegs = 4;   ///< Up, down, up, down.
  static constexpr int kParts = 2;  ///< Parts of an averaging time: a force that is not constant differs in them.
  struct Leg {
    std::array<Vec3, kParts> force_n{Vec3::Zero(), Vec3::Zero()};  ///< Sums.
    std::array<int, kParts> count{};
    double turning_nmm = 0.0, level = 0.0;  ///< Sums of the torque about turning_axis_, and of the stylus' level part.
    int at_limit = 0, at_torque_limit = 0;
    double first_mm = 0.0, last_mm = 0.0;  ///< Height at the start and at the end of the averaging time.
  };

  Demand hold(const Pose& X_DT, double dt_s) noexcept;
  Wrench carried() const noexcept;
  Pose target() const noexcept;
  void settle(const Input& input, double dt_s) noexcept;
  void add(const Input& input) noexcept;
  void check_motion(const Input& input) noexcept;
  void end(const WeighResult& result) noexcept;
  void enter(Phase phase) noexcept;
  WeighResult evaluate() const noexcept;
  WeighRefusal find_refusal(const WeighResult& result) const noexcept;
  std::optional<double> lever_mm(double weight_n) const noexcept;

  const stylus::DeviceCapability device_;
  const bool has_force_;
  const double continuous_n_;
  const detail::PoseHoldParams params_;
  detail::PoseHold hold_;
  Phase phase_ = Phase::kIdle;
  double phase_s_ = 0.0, rested_s_ = 0.0, since_fresh_s_ = 0.0;
  Pose start_X_DS_;
  Vec3 stuck_p_D_ = Vec3::Zero(), stuck_n_ = Vec3::Zero();  ///< Last new position, and the force at it.
  Vec3 turning_axis_ = Vec3::Zero();  ///< Horizontal, across the stylus; zero if it is nearly vertical.
  double rest_n_ = 0.0;               ///< Vertical force at rest.
  std::array<Leg, kLegs> legs_;
  std::optional<WeighResult> result_;
};

}  // namespace trocar::server
