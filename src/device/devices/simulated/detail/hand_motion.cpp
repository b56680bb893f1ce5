#include "devices/simulated/detail/hand_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::devices {

HandNow hand_at(const DeviceHand& hand, double time_s) noexcept {
  const double late_s = time_s - hand.time_s;
  const double ahead_s = std::clamp(late_s, -kMaxExtrapolation_s, kMaxExtrapolation_s);
  HandNow now;
  now.X_DS = Pose(rotation_from_vector(hand.w_D * ahead_s) * hand.X_DS.R(), hand.X_DS.p() + hand.v_D * ahead_s);
  if (std::abs(late_s) > kMaxExtrapolation_s) return now;
  now.v_D = hand.v_D;
  now.w_D = hand.w_D;
  return now;
}

bool is_valid(const DeviceHand& hand) noexcept {
  const std::array amounts{hand.stiffness_n_per_mm,          hand.damping_ns_per_mm, hand.mass_kg,
                           hand.turning_nmm_per_rad,         hand.inertia_kg_mm2,    hand.point_mm,
                           hand.turning_damping_nmms_per_rad};
  const bool has_amounts =
      std::all_of(amounts.begin(), amounts.end(), [](double amount) { return std::isfinite(amount) && amount >= 0.0; });
  return has_amounts && hand.X_DS.is_finite() && hand.v_D.allFinite() && hand.w_D.allFinite() &&
         std::isfinite(hand.time_s);
}

bool is_valid(const Wrench& wrench) noexcept {
  return wrench.force_n.norm() <= kMostPlausibleForce_n && wrench.torque_nmm.norm() <= kMostPlausibleTorque_nmm;
}

}  // namespace trocar::devices
