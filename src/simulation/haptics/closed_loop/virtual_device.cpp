#include "haptics/closed_loop/virtual_device.h"

namespace trocar::haptics {

void step_device(VirtualDeviceState& state, const VirtualDeviceParams& params, const HandHold& hand,
                 const Vec3& force_P, const Vec3& gravity_P, double dt_s) noexcept {
  constexpr double kMmPerM = 1000.0;
  const double mass = (params.mass_kg + hand.mass_kg) / kMmPerM;  // N s^2/mm
  const double k = hand.stiffness_n_per_mm;
  const double b = hand.damping_ns_per_mm;
  const Vec3 outer = force_P + gravity_P * params.weight_n;
  // Implicit Euler in the hand's spring and damper: m dv/dt = k (anchor - p) + b (v_anchor - v) + outer.
  const Vec3 push = k * (hand.anchor_P - state.X_PN.p()) + b * hand.anchor_velocity_P + outer;
  state.v_P = (mass * state.v_P + dt_s * push) / (mass + dt_s * b + dt_s * dt_s * k);
  state.X_PN = Pose(hand.R_PN, state.X_PN.p() + dt_s * state.v_P);
}

}  // namespace trocar::haptics
