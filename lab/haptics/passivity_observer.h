#pragma once

#include <algorithm>

#include "geometry/vec.h"

namespace trocar::haptics {

/// Sums the energy supplied to a device: E = sum (f.v + tau.w) dt (physics.md H5). Tissue can only return stored
/// energy: without external work E must not grow. After Hannaford and Ryu's time domain observer. Real-time safe.
class PassivityObserver {
 public:
  /// One tick: the wrench that acted on the device and its mean velocities meanwhile (mm/s, rad/s), all in one frame
  /// and about one point.
  void add(const Wrench& wrench, const Vec3& v, const Vec3& w, double dt_s) noexcept {
    energy_mj_ += (wrench.force_n.dot(v) + wrench.torque_nmm.dot(w)) * dt_s;
    lowest_mj_ = std::min(lowest_mj_, energy_mj_);
    highest_mj_ = std::max(highest_mj_, energy_mj_);
    growth_mj_ = std::max(growth_mj_, energy_mj_ - lowest_mj_);
  }

  /// Energy supplied to the device since the start; negative: absorbed from it.
  double energy_mj() const noexcept { return energy_mj_; }
  /// Largest rise of the energy from any earlier moment. A passive environment keeps it below its stored energy.
  double growth_mj() const noexcept { return growth_mj_; }
  /// Smallest and largest energy since the start; 0 counts.
  double lowest_mj() const noexcept { return lowest_mj_; }
  double highest_mj() const noexcept { return highest_mj_; }

 private:
  double energy_mj_ = 0.0;  // N mm
  double lowest_mj_ = 0.0;
  double highest_mj_ = 0.0;
  double growth_mj_ = 0.0;
};

}  // namespace trocar::haptics
