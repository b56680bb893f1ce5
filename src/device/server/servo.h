#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "devices/haptic_device.h"
#include "devices/workspace_map.h"
#include "haptics/gate/safety_gate.h"
#include "haptics/tick.h"
#include "link/messages.h"
#include "server/detail/pose_hold.h"

namespace trocar::server {

/// Scene of the servo. The control thread builds it; it is swapped as a whole.
struct ServoScene {
  std::shared_ptr<const haptics::HapticScene> scene;
  std::uint64_t number = 0;  ///< Increases with every scene.
  bool continues = false;    ///< The insertion continues: same patient with other parameters.
};

/// Parameters of a device, constant during the lifetime of the servo.
struct ServoParams {
  haptics::GateParams gate;
  devices::WorkspaceParams workspace;
  double stuck_s = 5.0;  ///< Identical readings for this time above stuck_n: stuck encoder (a hand trembles). [assumed]
  double stuck_n = 1.0;
  double max_hole_s = 0.25;  ///< A longer period latches a fault; equal to the timeout of a client. [assumed]
};

/// Gate, calibration and scales of a device's preset; a stuck encoder is detected above 0.15 of its continuous force
/// [assumed].
ServoParams servo_params(const stylus::DevicePreset& preset, double rate_hz = 1000.0) noexcept;

/// Input of a period from the other threads.
struct ServoInput {
  double now_s = 0.0;
  double dt_s = 0.001;
  double busy_s = 0.0;                   ///< Part of dt_s used by the work of the last period.
  const ServoScene* scene = nullptr;     ///< Null: no forces.
  std::optional<link::HandTarget> hand;  ///< Set if a new target came.
  double silence_s = 0.0;                ///< Time since the last message of the client in control.
  bool is_wanted = false;                ///< Forces are requested.
  bool is_reset = false;                 ///< A fault reset is requested.
  bool is_stylet_in = true;
};

/// Interval between the shapes of the needle that are sent: the shaft bends with the hand, and a screen shows 60 frames
/// a second.
inline constexpr double kShapeEvery_s = 0.01;

/// Output of a period: for clients, recorder and flight recorder. Fixed size.
struct ServoRecord {
  std::uint64_t tick = 0;
  std::uint64_t scene = 0;       ///< Number of the scene of this tick; 0: none.
  telemetry::TickSample sample;  ///< device_f_n is the force that the gate wrote, in P.
  devices::DeviceStatus status = devices::DeviceStatus::kFresh;
  std::uint16_t actions = 0;  ///< Of the gate; its mode, fault and scale are in the sample.
  double drop_n = 0.0, drop_s = 0.0;
  std::optional<telemetry::NeedleShape> shape;  ///< Of a needle, every kShapeEvery_s.
  Wrench wanted_D, written_D;
  Pose X_DS;
  std::uint32_t buttons = 0;
  double silence_s = 0.0;
};

/// One period of a haptic server: read, hold, map, tick, gate, write. Time is an argument; no clock, lock or
/// allocation: the same inputs give the same records. Only the servo accesses the device while it runs.
class Servo {
 public:
  Servo(devices::HapticDevice& device, const ServoParams& params) noexcept;
  ServoRecord step(const ServoInput& input) noexcept;
  telemetry::GateMode mode() const noexcept { return gate_.mode; }
  /// True if the last written wrench is not zero.
  bool gives_force() const noexcept;
  /// Call it after the device was leased: earlier readings and outputs are discarded, and forces return through the
  /// safe start. A fault is kept.
  void resume() noexcept;

 private:
  struct Wanted {
    Wrench wrench_D, weight_D;
    Vec3 axis_D = Vec3::UnitZ();
  };
  struct Sensed {
    devices::DeviceReading reading;
    Vec3 v_D = Vec3::Zero(), w_D = Vec3::Zero();
    telemetry::GateFault fault = telemetry::GateFault::kNone;
  };
  Sensed sense(const ServoInput& input) noexcept;
  telemetry::GateFault watch_encoder(const devices::DeviceReading& reading, double dt_s) noexcept;
  /// Restarts the tool at its present pose: for a new scene, or a placed hand (link::HandTarget::pressed_mm).
  void reset(double pressed_mm = 0.0) noexcept;
  Wanted feel(const Sensed& sensed, const ServoInput& input, telemetry::TickSample& sample) noexcept;
  devices::DeviceHand hand_in_device(const link::HandTarget& target, const haptics::HapticScene& scene) const noexcept;
  stylus::CouplingParams coupling_in_device(const ServoScene* scene) const noexcept;
  void note_shape(const ServoInput& input, ServoRecord& record) noexcept;
  void note_gate(const haptics::GateOutput& output, const ServoInput& input, telemetry::TickSample& sample) noexcept;

  devices::HapticDevice& device_;
  ServoParams params_;
  bool has_torque_, senses_rotation_, is_watched_;  ///< is_watched_: for a stuck encoder.
  devices::WorkspaceState workspace_;
  haptics::GateState gate_;
  haptics::HapticState tick_;
  std::uint64_t scene_number_ = 0;
  std::uint64_t ticks_ = 0;
  double shape_s_ = 0.0;  ///< Time of the last shape.
  bool has_read_ = false;
  bool was_placed_ = false;                 ///< The hand target of the last period had is_placed.
  double pressed_mm_ = 0.0;                 ///< Of that target.
  devices::DeviceReading last_;             ///< Last fresh reading with a valid pose.
  Mat3 commanded_R_WS_ = Mat3::Identity();  ///< Used if the device senses no rotation; from the hand target.
  detail::ReadingAge age_;
  double unmoved_s_ = 0.0;
  bool has_refused_ = false;  ///< The device did not take the last wrench.
  std::uint16_t actions_before_ = 0;
};

}  // namespace trocar::server
