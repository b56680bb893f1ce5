#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "devices/vendor/detail/hd_api.h"
#include "devices/vendor/detail/servo_exchange.h"

namespace trocar::devices::hd {

/// Data that the device reports; empty where it reports no usable value.
struct Description {
  std::string model;
  int output_dof = 3;
  std::optional<double> peak_force_n, continuous_force_n, stiffness_n_per_mm, peak_torque_nmm, continuous_torque_nmm;
  Vec3 centre_V = Vec3::Zero();  ///< Middle of the usable workspace, mm, in the vendor's axes.
};

/// V, the vendor's axes: x right, y up, z towards the user. D: x right, y away, z up.
Mat3 R_DV() noexcept;
/// H, the vendor's stylus: +z from its tip to its tail. S: +z from the grip to the tip.
Mat3 R_HS() noexcept;

/// An initialised device; the vendor's scheduler runs the callback of this class. Invariant: hdInitDevice returned
/// `handle_`, and the device stays initialised. The destructor leaves the motors at zero and disables the device.
class Connection {
 public:
  /// `is_calibrating`: a person holds the device in its calibration position; see OpenHapticsOptions.
  static Result<std::unique_ptr<Connection>> open(const std::string& device, double (*clock_s)() noexcept,
                                                  bool is_calibrating);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  const Description& description() const noexcept { return description_; }
  ServoExchange& exchange() noexcept { return *exchange_; }
  /// The vendor's text for the last error of the callback; empty: none.
  std::string last_error() const;

 private:
  Connection(const Api& api, Handle handle, double (*clock_s)() noexcept, bool is_calibrating)
      : api_(api), handle_(handle), clock_s_(clock_s), is_calibrating_(is_calibrating) {}
  Status start();
  Status calibrate();
  void describe();
  std::optional<double> positive(Enum name);
  Status check(const char* what);

  static unsigned int on_period(void* connection);
  static unsigned int on_first_period(void* connection);
  static unsigned int on_closing(void* connection);
  static unsigned int on_calibration_update(void* connection);
  void serve() noexcept;
  ServoSample sense() noexcept;
  void apply(const Wrench& wrench_D) noexcept;
  void take_errors(ServoSample& sample) noexcept;

  const Api api_;
  const Handle handle_;
  double (*const clock_s_)() noexcept;
  const bool is_calibrating_;
  Description description_;
  ServoSample first_;
  Enum calibration_ = kCalibrationOk;
  int calibration_style_ = 0;
  SchedulerHandle callback_ = 0;
  bool has_scheduler_ = false;
  bool has_callback_ = false;
  std::optional<ServoExchange> exchange_;
  std::atomic<Enum> last_error_{kSuccess};
  std::atomic<bool> is_lost_{false};
  bool is_done_ = false;  ///< Used only by the scheduler's thread.
};

}  // namespace trocar::devices::hd
