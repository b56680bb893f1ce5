#pragma once

#include <algorithm>

#include "geometry/pose.h"
#include "geometry/vec.h"

namespace trocar::server::detail {

/// Gains and limits of a PoseHold. The spring is softer than every coupling of data/devices.toml, and the integral
/// slow enough for a mass of 0.5 kg (m k_i < b k). All [assumed]; the tests hold every preset.
struct PoseHoldParams {
  double stiffness_n_per_mm = 0.2;
  double damping_ns_per_mm = 0.004;
  double integral_n_per_mm_s = 1.0;
  double turning_nmm_per_rad = 100.0;
  double turning_damping_nmms = 3.0;
  double turning_integral_nmm_per_rad_s = 400.0;
  double filter_s = 0.003;  ///< Low-pass of the velocities: smooths single encoder counts.
  double most_n = 1.0;      ///< Largest force of hold and carried weight together.
  double most_nmm = 0.0;    ///< The same of the torque; 0: the device has no torque, and the direction is free.
};

/// Holds a stylus at a target pose: spring, damper and integral of the error, limited. Frame D, about S. Time is an
/// argument; real-time safe.
class PoseHold {
 public:
  explicit PoseHold(const PoseHoldParams& params) noexcept : params_(params) {}

  /// Starts anew, at rest at this pose.
  void begin(const Pose& X_DS) noexcept;
  /// Takes a new reading after `since_s` (s) since the last one.
  void sense(const Pose& X_DS, double since_s) noexcept;
  /// Wrench of the hold in addition to `carried`. `may_learn`: the integral grows.
  Wrench step(const Pose& X_DT, const Wrench& carried, bool may_learn, double dt_s) noexcept;

  const Pose& X_DS() const noexcept { return X_DS_; }
  const Vec3& v_mm_per_s() const noexcept { return v_mm_per_s_; }
  /// The last step needed more force than most_n.
  bool is_at_limit() const noexcept { return is_at_limit_; }
  bool is_at_torque_limit() const noexcept { return is_at_torque_limit_; }

 private:
  PoseHoldParams params_;
  Pose X_DS_;
  Vec3 v_mm_per_s_ = Vec3::Zero(), w_rad_per_s_ = Vec3::Zero();
  Vec3 learnt_n_ = Vec3::Zero(), learnt_nmm_ = Vec3::Zero();
  bool is_at_limit_ = false, is_at_torque_limit_ = false;
};

/// Age of a device's last fresh reading.
class ReadingAge {
 public:
  /// One period of `dt_s` seconds whose reading is fresh or not. Returns the time since the fresh reading before, s.
  double advance(bool is_fresh, double dt_s, double max_unread_s) noexcept {
    // A busy machine that delays this loop delays the driver as well: the device is not silent before some periods in
    // turn have brought nothing.
    constexpr double kFewestPeriods = 4.0;
    const double since_s = age_s_ + dt_s;
    age_s_ = is_fresh ? 0.0 : since_s;
    unread_s_ = is_fresh ? 0.0 : unread_s_ + std::min(dt_s, max_unread_s / kFewestPeriods);
    return since_s;
  }
  /// The device's silence, s: the age, in which a period counts for at most a quarter of `max_unread_s`.
  double unread_s() const noexcept { return unread_s_; }

 private:
  double age_s_ = 0.0;
  double unread_s_ = 0.0;
};

}  // namespace trocar::server::detail
