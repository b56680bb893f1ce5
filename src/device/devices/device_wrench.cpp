#include "devices/device_wrench.h"

#include <algorithm>
#include <cmath>

namespace trocar::devices {

Wrench without_torque(const Wrench& wrench, const Vec3& axis, const std::optional<Vec3>& p_SE) noexcept {
  Wrench turned{wrench.force_n, Vec3::Zero()};
  if (!p_SE) return turned;
  // A lateral force g at S has the moment -lever axis x g about the entry point: g = axis x torque / lever replaces the
  // torque, except its component along the axis, which cannot be replaced.
  const double lever_mm = p_SE->dot(axis);
  const double least_mm = std::max(std::abs(lever_mm), kLeastLever_mm);
  turned.force_n += axis.cross(wrench.torque_nmm) * (lever_mm / (least_mm * least_mm));
  return turned;
}

}  // namespace trocar::devices
