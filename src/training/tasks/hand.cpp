#include "tasks/hand.h"

#include <cmath>

namespace trocar::tasks {

HandSpring hand_spring(const HandParams& hand, const HandCommand& command) noexcept {
  return {command.X_PN.p(), command.v_P, command.grip * hand.stiffness_n_per_mm,
          std::sqrt(command.grip) * hand.damping_ns_per_mm, hand.mass_kg};
}

Vec3 hand_force_n(const HandParams& hand, const HandCommand& command, const Pose& X_PN_device,
                  const Vec3& v_P) noexcept {
  const HandSpring spring = hand_spring(hand, command);
  return spring.stiffness_n_per_mm * (spring.anchor_P - X_PN_device.p()) +
         spring.damping_ns_per_mm * (spring.anchor_velocity_P - v_P);
}

Mat3 follow_rotation(const HandParams& hand, const Mat3& R_PN, const Mat3& R_PN_wanted, double dt_s) noexcept {
  const double fraction = 1.0 - std::exp(-dt_s / hand.turning_time_constant_s);
  const Eigen::Quaterniond now(R_PN);
  return now.slerp(fraction, Eigen::Quaterniond(R_PN_wanted)).normalized().toRotationMatrix();
}

}  // namespace trocar::tasks
