#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "devices/test/standin/hd_stand_in.h"
#include "devices/test/standin/violations.h"
#include "devices/testing/hd_stand_ins.h"
#include "devices/vendor/detail/hd_api.h"

namespace trocar::testing {

struct HdJob {
  devices::hd::SchedulerHandle handle;
  devices::hd::Callback callback;
  void* user;
  unsigned short priority;
  bool is_synchronous;
};

/// The simulated device and the vendor's scheduler. One mutex guards all members; callbacks run without the lock.
class HdSimulatedDevice final : public HdStandIn {
 public:
  void reset() override {
    const std::lock_guard lock(mutex_);
    state_ = State();
    violations_.clear();
  }
  void set_model(const char* model, int output_dof) override {
    const std::lock_guard lock(mutex_);
    state_.model = model;
    state_.output_dof = output_dof;
  }
  void set_nominal(double force_n, double continuous_n, double stiffness_n_per_mm, double torque_nmm) override {
    const std::lock_guard lock(mutex_);
    state_.force_n = force_n;
    state_.continuous_n = continuous_n;
    state_.stiffness_n_per_mm = stiffness_n_per_mm;
    state_.torque_nmm = torque_nmm;
  }
  void set_workspace(const Vec3& least_mm, const Vec3& greatest_mm) override {
    const std::lock_guard lock(mutex_);
    state_.least_mm = least_mm;
    state_.greatest_mm = greatest_mm;
  }
  void set_calibration(unsigned status, int style) override {
    const std::lock_guard lock(mutex_);
    state_.calibration = status;
    state_.calibration_style = style;
  }
  void hold_in_reset_position(bool is_held) override {
    const std::lock_guard lock(mutex_);
    state_.is_in_reset_position = is_held;
  }
  void set_present(bool is_present) override {
    const std::lock_guard lock(mutex_);
    state_.is_present = is_present;
    if (!is_present) cut_motors();
  }
  void set_pose(const Mat3& R, const Vec3& p_mm) override {
    const std::lock_guard lock(mutex_);
    state_.arm.R = R;
    state_.arm.p_mm = p_mm;
    state_.arm.v_mm_per_s.setZero();
  }
  void set_buttons(int bits) override {
    const std::lock_guard lock(mutex_);
    state_.buttons = bits;
  }
  void send_nan(bool is_nan) override {
    const std::lock_guard lock(mutex_);
    state_.is_nan = is_nan;
  }
  void push_error(unsigned code) override {
    const std::lock_guard lock(mutex_);
    state_.coming_errors.push_back(code);
  }
  void step(int periods) override {
    std::unique_lock lock(mutex_);
    if (!is_running_) return;
    granted_ += periods;
    changed_.notify_all();
    changed_.wait(lock, [&] { return granted_ == 0 || !is_running_; });
  }
  void run_freely(bool is_free) override {
    const std::lock_guard lock(mutex_);
    state_.is_free = is_free;
    changed_.notify_all();
  }
  SimulatedArm arm() const override {
    const std::lock_guard lock(mutex_);
    return state_.arm;
  }
  bool is_open() const override {
    const std::lock_guard lock(mutex_);
    return state_.is_open || is_running_;
  }
  bool has_force_output() const override {
    const std::lock_guard lock(mutex_);
    return state_.has_force_output;
  }
  std::string violations() const override {
    const std::lock_guard lock(mutex_);
    return violations_.text();
  }

  // Implementation of the vendor's functions.
  devices::hd::Handle init(const char* name);
  void disable_device(devices::hd::Handle handle);
  void begin(devices::hd::Handle handle);
  void end(devices::hd::Handle handle);
  devices::hd::ErrorInfo pop_error();
  void enable(devices::hd::Enum capability, bool is_on);
  void get_integers(devices::hd::Enum name, int* values);
  void get_doubles(devices::hd::Enum name, double* values);
  void set_doubles(devices::hd::Enum name, const double* values);
  const char* get_string(devices::hd::Enum name);
  devices::hd::Enum check_calibration();
  void update_calibration(devices::hd::Enum style);
  void start();
  void stop();
  void set_rate(unsigned long hz);
  devices::hd::SchedulerHandle schedule(devices::hd::Callback callback, void* user, unsigned short priority,
                                        bool is_synchronous);
  void unschedule(devices::hd::SchedulerHandle handle);
  void require_open(const char* rule) {
    const std::lock_guard lock(mutex_);
    violations_.require(state_.is_open, rule);
  }

 private:
  struct State {
    SimulatedArm arm;
    std::string model = "PHANTOM Omni";
    int output_dof = 3;
    double force_n = 3.3, continuous_n = 0.88, stiffness_n_per_mm = 0.5, torque_nmm = 0.0;
    Vec3 least_mm = Vec3(-80, -60, -35), greatest_mm = Vec3(80, 60, 35);
    unsigned calibration = devices::hd::kCalibrationOk;
    int calibration_style = devices::hd::kStyleInkwell;
    int buttons = 0;
    bool is_in_reset_position = false;
    bool is_present = true;
    bool is_open = false;
    bool is_nan = false;
    bool is_free = false;
    bool has_force_output = false;
    bool has_clamping = true;
    bool is_in_frame = false;
    bool had_frame = false;  ///< A frame was begun in this period.
    Vec3 wanted_n = Vec3::Zero(), wanted_nmm = Vec3::Zero();
    std::vector<devices::hd::Enum> errors, coming_errors;
  };

  void run();
  void run_period(std::unique_lock<std::mutex>& lock);
  void cut_motors() {
    state_.arm.force_n.setZero();
    state_.arm.torque_nmm.setZero();
  }
  /// Controls of the device with that name, if a test process has made them; null: none.
  HdControls* find_controls(const char* name);
  void take_controls();
  bool is_on_scheduler() const { return std::this_thread::get_id() == thread_id_; }
  void require_frame(const char* rule) {
    violations_.require(state_.is_open && state_.is_in_frame && is_on_scheduler(), rule);
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_;
  Violations violations_;
  std::vector<HdJob> jobs_;
  std::thread thread_;
  std::thread::id thread_id_;
  HdControls* controls_ = nullptr;
  double tremor_rad_ = 0.0;
  bool is_running_ = false;
  int granted_ = 0;
  devices::hd::SchedulerHandle next_handle_ = 1;
};

}  // namespace trocar::testing
