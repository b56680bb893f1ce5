#include "haptics/simulation/virtual_stylus.h"

#include "haptics/simulation/rotation.h"

namespace trocar {

StylusMotion step_stylus(VirtualStylusState& state, const VirtualStylusParams& params, const StylusHold& hold,
                         const Wrench& wrench_P, const Vec3& gravity_P, double dt_s) noexcept {
  constexpr double kMmPerM = 1000.0;
  const Vec3 weight = gravity_P * params.weight_n;
  const double half_s = 0.5 * dt_s;

  // Trapezoidal rule: m dv/dt = k (anchor - p) + b (v_anchor - v) + outer force, constant over the tick; v is the mean.
  const double mass = (params.mass_kg + hold.mass_kg) / kMmPerM;  // N s^2/mm
  const double k = hold.stiffness_n_per_mm;
  const double b = hold.damping_ns_per_mm;
  const Vec3 push =
      k * (hold.X_PS.p() - state.X_PS.p()) + b * hold.velocity_P + wrench_P.force_n + weight + hold.push_n;
  const Vec3 v = (mass * state.v_P + half_s * push) / (mass + half_s * b + half_s * dt_s * 0.5 * k);

  // The same about S, with the rotation vector from where the stylus is to where the hand wants it.
  const double inertia = (params.inertia_kg_mm2 + hold.inertia_kg_mm2) / kMmPerM;  // N mm s^2/rad
  const double k_turn = hold.turning_nmm_per_rad;
  const double b_turn = hold.turning_damping_nmms_per_rad;
  const Vec3 arm_P = state.X_PS.R() * Vec3(0.0, 0.0, -params.weight_lever_mm);
  Vec3 turn = wrench_P.torque_nmm + arm_P.cross(weight) + b_turn * hold.angular_velocity_P;
  if (k_turn > 0.0) turn += k_turn * rotation_vector(hold.X_PS.R() * state.X_PS.R().transpose());
  const Vec3 w = (inertia * state.w_P + half_s * turn) / (inertia + half_s * b_turn + half_s * dt_s * 0.5 * k_turn);

  const Eigen::Quaterniond turned(rotation_from_vector(dt_s * w) * state.X_PS.R());
  state.X_PS = Pose(turned.normalized().toRotationMatrix(), state.X_PS.p() + dt_s * v);
  state.v_P = 2.0 * v - state.v_P;
  state.w_P = 2.0 * w - state.w_P;
  return {v, w};
}

}  // namespace trocar
