#pragma once

#include <array>
#include <memory>

#include "haptics/tick.h"
#include "lab/haptics/passivity_observer.h"
#include "stylus/device_preset.h"
#include "stylus/virtual_stylus.h"

namespace trocar::haptics {

/// Holder of the simulated device.
enum class Holder { kHand, kGuidingHand, kBare45g, kBare150g };
inline constexpr std::array kAllHolders{Holder::kHand, Holder::kGuidingHand, Holder::kBare45g, Holder::kBare150g};
const char* to_string(Holder holder) noexcept;

/// A simulated device in closed loop with the tick. The pose is quantised to counts of the device's encoders. The
/// resulting wrench is held for a tick and acts one whole tick late (1.5 ticks of delay in all at 1 kHz: sampling,
/// computation, hold). Heap: one object; then real-time safe. Frame P: the device's base is the scene's.
class ClosedLoop {
 public:
  ClosedLoop(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset, Holder holder,
             double dt_s = 0.001);

  /// Moves the device along a prescribed path: one tick with the needle's tip and axis there.
  const telemetry::TickSample& carry(const Vec3& tip_P, const Vec3& axis_P) noexcept;
  /// One tick of the device on its own under `hold`.
  const telemetry::TickSample& run(const stylus::StylusHold& hold) noexcept;

  const stylus::VirtualStylusState& stylus() const noexcept { return stylus_; }
  stylus::VirtualStylusState& stylus() noexcept { return stylus_; }
  Vec3 tip_P() const noexcept { return (stylus_.X_PS * scene_->X_SN).p(); }
  const telemetry::TickSample& last() const noexcept { return sample_; }
  const Wrench& wrench_P() const noexcept { return wrench_P_; }
  const PassivityObserver& observer() const noexcept { return observer_; }
  void restart_observer() noexcept { observer_ = {}; }
  double time_s() const noexcept { return time_s_; }
  double dt_s() const noexcept { return dt_s_; }

 private:
  const telemetry::TickSample& sense() noexcept;

  std::shared_ptr<const HapticScene> scene_;
  stylus::EncoderParams encoder_;
  bool senses_rotation_;
  stylus::VirtualStylusParams params_;
  double dt_s_;
  double time_s_ = 0.0;
  stylus::VirtualStylusState stylus_;
  Mat3 reported_R_PS_ = Mat3::Identity();  ///< Orientation reported for a device that senses no rotation.
  Wrench wrench_P_;                        ///< About S: wrench of the last tick; acts during the tick after the next.
  Wrench acting_P_;                        ///< About S: wrench that acts during the next tick.
  Wrench next_weight_P_, weight_P_;        ///< Parts of these that carry the weight: not energy of the tissue.
  HapticState state_;
  telemetry::TickSample sample_;
  PassivityObserver observer_;
};

}  // namespace trocar::haptics
