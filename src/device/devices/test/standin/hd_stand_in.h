#pragma once

#include <string>

#include "devices/test/standin/simulated_arm.h"

namespace trocar::testing {

/// Controls of the simulated device behind a stand-in for libHD.so: the actions of a person at the device, and the
/// state of the device. All functions may be called from any thread.
class HdStandIn {
 public:
  virtual ~HdStandIn() = default;

  /// Resets to a newly connected device: an Omni at the origin, calibrated, 3.3 N, no violations, periods only by
  /// step().
  virtual void reset() = 0;
  virtual void set_model(const char* model, int output_dof) = 0;
  virtual void set_nominal(double force_n, double continuous_n, double stiffness_n_per_mm, double torque_nmm) = 0;
  virtual void set_workspace(const Vec3& least_mm, const Vec3& greatest_mm) = 0;
  virtual void set_calibration(unsigned status, int style) = 0;
  /// Sets whether a person holds the arm in its reset position, where an encoder reset is correct.
  virtual void hold_in_reset_position(bool is_held) = 0;
  virtual void set_present(bool is_present) = 0;  ///< false: disconnected, before or while it is open.
  virtual void set_pose(const Mat3& R, const Vec3& p_mm) = 0;
  virtual void set_buttons(int bits) = 0;
  virtual void send_nan(bool is_nan) = 0;
  virtual void push_error(unsigned code) = 0;  ///< The error is reported after the next frame.

  /// Makes the scheduler run `periods` periods, and waits for them.
  virtual void step(int periods) = 0;
  /// true: the scheduler runs one period per millisecond by itself.
  virtual void run_freely(bool is_free) = 0;

  virtual SimulatedArm arm() const = 0;
  virtual bool is_open() const = 0;
  virtual bool has_force_output() const = 0;
  virtual std::string violations() const = 0;  ///< One line per violated rule.
};

}  // namespace trocar::testing

/// Exported by the stand-in in addition to the vendor's functions.
extern "C" trocar::testing::HdStandIn* trocar_hd_stand_in();
