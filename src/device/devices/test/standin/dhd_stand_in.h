#pragma once

#include <string>

#include "devices/test/standin/simulated_arm.h"

namespace trocar::testing {

/// Controls of the simulated device behind a stand-in for libdhd.so: the actions of a person at the device, and the
/// state of the device. All functions may be called from any thread.
class DhdStandIn {
 public:
  virtual ~DhdStandIn() = default;

  /// Resets to a newly switched-on device: an omega.6 at the origin, calibrated, watchdog at 100 ms, no violations.
  virtual void reset() = 0;
  virtual void set_type(int type, const char* name, bool has_active_wrist) = 0;
  virtual void set_present(bool is_present) = 0;  ///< false: disconnected, before or while it is open.
  virtual void set_calibrated(bool is_calibrated) = 0;
  virtual void set_watchdog(unsigned char counts) = 0;
  virtual void set_pose(const Mat3& R, const Vec3& p_mm) = 0;
  virtual void set_button(int index, bool is_down) = 0;
  virtual void send_nan(bool is_nan) = 0;
  virtual void answer_time_guard(bool is_early) = 0;  ///< true: reads return DHD_TIMEGUARD (called too early).
  /// Simulates the device's safety functions: switches the motors off for this cause; 0: on again.
  virtual void force_off(int cause) = 0;

  virtual SimulatedArm arm() const = 0;  ///< mm, N, N mm
  virtual bool is_open() const = 0;
  virtual bool has_force() const = 0;
  virtual bool has_gravity_compensation() const = 0;
  virtual unsigned char watchdog() const = 0;
  virtual std::string violations() const = 0;  ///< One line per violated rule.
};

}  // namespace trocar::testing

/// Exported by the stand-in in addition to the vendor's functions.
extern "C" trocar::testing::DhdStandIn* trocar_dhd_stand_in();
