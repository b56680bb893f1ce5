#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/shapes.h"
#include "tasks/operator.h"

namespace trocar::tasks {

/// Involuntary movement of the hand: a few sines in the physiological band on each axis, a function of time alone.
class Tremor {
 public:
  /// rms_mm: across the needle, each axis; along the needle a tenth of it.
  Tremor(double rms_mm, std::uint64_t seed) noexcept;
  Vec3 offset_N(double time_s) const noexcept;    ///< mm, in needle axes.
  Vec3 velocity_N(double time_s) const noexcept;  ///< mm/s.

 private:
  struct Sine {
    double amplitude_mm;
    double angular_rad_s;
    double phase_rad;
  };
  static constexpr std::size_t kSines = 3;
  std::array<std::array<Sine, kSines>, 3> axes_;
};

// Both of expert and novice; assumed.
inline constexpr double kAfterFire_s = 0.5;   ///< Between the shot and the withdrawal.
inline constexpr double kOutOfTime_s = 58.0;  ///< The withdrawal ends even if the tip is still inside.

/// Common part of expert and novice: a hand that moves its wanted pose along a straight line with smooth speed, and
/// reads the tip's position and the device's force. Positions along the line are mm from its start, positive inward.
class GuidedHand {
 public:
  /// `bevel_P`: direction that the bevel faces; empty: any.
  /// `grip`: HandCommand::grip.
  GuidedHand(const Segment& line_P, const std::optional<Vec3>& bevel_P, double start_mm, const Tremor& tremor,
             double grip = 1.0) noexcept;

  /// Reads tip and force; call it once per tick, first.
  void sense(const OperatorView& view) noexcept;
  /// Moves the wanted pose with a speed that follows `speed_mm_s` smoothly. The lead of the wanted pose over the device
  /// is limited.
  void move(double speed_mm_s, double dt_s) noexcept;
  HandCommand command() const noexcept;
  /// Goes on along another line; for a needle outside of the body.
  void turn_to(const Segment& line_P, const std::optional<Vec3>& bevel_P) noexcept;

  double elapsed_s() const noexcept { return elapsed_s_; }
  double wanted_mm() const noexcept { return wanted_mm_; }
  double tip_mm() const noexcept { return tip_mm_; }  ///< Tip of the virtual needle, along the line.
  /// Force against the insertion, smoothed like a hand's perception.
  double push_n() const noexcept { return push_n_; }
  bool is_touching() const noexcept { return is_touching_; }
  /// The felt force has just dropped: the resistance gave way. True for one tick.
  bool has_felt_drop() const noexcept { return has_felt_drop_; }

 private:
  Vec3 start_P_;
  Vec3 axis_P_;
  Mat3 R_PN_;
  Tremor tremor_;
  double grip_;
  double wanted_mm_;
  double speed_mm_s_ = 0.0;
  double speed_ahead_mm_s_ = 0.0;  // first of two smoothing stages
  double start_time_s_ = 0.0;
  double elapsed_s_ = 0.0;
  double device_mm_;
  double tip_mm_;
  double push_n_ = 0.0;
  double peak_push_n_ = 0.0;
  bool is_first_ = true;
  bool is_touching_ = false;
  bool has_felt_drop_ = false;
};

/// Detects a needle that does not advance.
class StallWatch {
 public:
  /// Seconds since the tip last gained a millimetre, or since `from_s` if that is later.
  double stalled_s(const GuidedHand& hand, double from_s) noexcept {
    constexpr double kGain_mm = 1.0;
    if (hand.tip_mm() > deepest_mm_ + kGain_mm) {
      deepest_mm_ = hand.tip_mm();
      gained_s_ = hand.elapsed_s();
    }
    return hand.elapsed_s() - std::max(gained_s_, from_s);
  }

 private:
  double deepest_mm_ = -std::numeric_limits<double>::infinity();
  double gained_s_ = 0.0;
};

/// Asks the patient to hold the breath, and to breathe again.
class BreathCommand {
 public:
  explicit BreathCommand(bool is_used) noexcept : is_used_(is_used) {}

  /// Asks if the breath is not held. True: not held yet, wait; false as well for a patient who does not manage it.
  bool waits(const OperatorView& view, double now_s) noexcept {
    if (!is_used_ || view.last.is_breath_held) {
      was_held_ = was_held_ || view.last.is_breath_held;
      return false;
    }
    if (std::exchange(was_held_, false)) asked_s_.reset();  // breathes again: is asked again
    if (!asked_s_) {
      asked_s_ = now_s;
      wanted_ = ActionKind::kHoldBreath;
    }
    is_used_ = now_s - *asked_s_ <= kPatience_s;
    return is_used_;
  }
  void release() noexcept {
    if (asked_s_) wanted_ = ActionKind::kBreathe;
    asked_s_.reset();
    was_held_ = false;
  }
  std::optional<ActionKind> take() noexcept { return std::exchange(wanted_, std::nullopt); }

 private:
  static constexpr double kPatience_s = 8.0;  // about two breaths; assumed
  bool is_used_;
  bool was_held_ = false;
  std::optional<double> asked_s_;
  std::optional<ActionKind> wanted_;
};

/// The actions that a scripted operator has still to do, each once.
class PendingActions {
 public:
  explicit PendingActions(const OperatorActions& actions) noexcept : left_(actions) {}

  void forget_anaesthetic() noexcept { left_.gives_anaesthetic = false; }
  void forget_confirmation() noexcept { left_.confirms.reset(); }
  void look_again(ActionKind confirms) noexcept { left_.confirms = confirms; }

  /// The action that is due: anaesthetic at the skin, the others at the target, the guide wire `kBeforeWire_s` after
  /// the arrival. `tip_mm`: along the path from its entry. `at_target_s`: time since the arrival; empty: not there.
  std::optional<ActionRequest> next(double tip_mm, std::optional<double> at_target_s) noexcept {
    if (left_.gives_anaesthetic && tip_mm > -kAtSkin_mm) {
      left_.gives_anaesthetic = false;
      return ActionRequest{ActionKind::kAnaesthetise, kAnaesthetic_ml};
    }
    if (!at_target_s) return std::nullopt;
    if (left_.confirms) return ActionRequest{*std::exchange(left_.confirms, std::nullopt), 0.0};
    if (left_.wire_mm > 0.0 && *at_target_s > kBeforeWire_s)
      return ActionRequest{ActionKind::kAdvanceWire, std::exchange(left_.wire_mm, 0.0)};
    return std::nullopt;
  }

 private:
  static constexpr double kAnaesthetic_ml = 5.0;
  static constexpr double kAtSkin_mm = 4.0;
  static constexpr double kBeforeWire_s = 0.25;
  OperatorActions left_;
};

}  // namespace trocar::tasks
