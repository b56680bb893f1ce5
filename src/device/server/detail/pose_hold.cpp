#include "server/detail/pose_hold.h"

#include <cmath>

#include "geometry/vec.h"

namespace trocar::server::detail {

void PoseHold::begin(const Pose& X_DS) noexcept {
  const PoseHoldParams params = params_;
  *this = PoseHold(params);
  X_DS_ = X_DS;
}

void PoseHold::sense(const Pose& X_DS, double since_s) noexcept {
  const double share = -std::expm1(-since_s / params_.filter_s);
  v_mm_per_s_ += share * ((X_DS.p() - X_DS_.p()) / since_s - v_mm_per_s_);
  w_rad_per_s_ += share * (rotation_vector(X_DS.R() * X_DS_.R().transpose()) / since_s - w_rad_per_s_);
  X_DS_ = X_DS;
}

Wrench PoseHold::step(const Pose& X_DT, const Wrench& carried, bool may_learn, double dt_s) noexcept {
  const Vec3 off_mm = X_DT.p() - X_DS_.p();
  const Vec3 off_rad = rotation_vector(X_DT.R() * X_DS_.R().transpose());
  Vec3 force_n =
      carried.force_n + learnt_n_ + params_.stiffness_n_per_mm * off_mm - params_.damping_ns_per_mm * v_mm_per_s_;
  Vec3 torque_nmm = carried.torque_nmm + learnt_nmm_ + params_.turning_nmm_per_rad * off_rad -
                    params_.turning_damping_nmms * w_rad_per_s_;
  is_at_limit_ = clamp_norm(force_n, params_.most_n);
  is_at_torque_limit_ = clamp_norm(torque_nmm, params_.most_nmm);
  // At a limit the integral would grow without an effect.
  if (may_learn && !is_at_limit_) learnt_n_ += dt_s * params_.integral_n_per_mm_s * off_mm;
  if (may_learn && !is_at_torque_limit_) learnt_nmm_ += dt_s * params_.turning_integral_nmm_per_rad_s * off_rad;
  return {force_n - carried.force_n, torque_nmm - carried.torque_nmm};
}

}  // namespace trocar::server::detail
