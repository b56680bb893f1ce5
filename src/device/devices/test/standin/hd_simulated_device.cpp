#include "devices/test/standin/hd_simulated_device.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace trocar::testing {
namespace {

constexpr devices::hd::Handle kHandle = 7;
constexpr double kPeriod_s = 0.001;
constexpr int kPriority = 81;  ///< Just above the loop that it serves.

}  // namespace

devices::hd::Handle HdSimulatedDevice::init(const char* name) {
  const std::lock_guard lock(mutex_);
  violations_.require(!state_.is_open, "hdInitDevice of a device that is open");
  bool is_known = name == nullptr || std::string(name) == "Default Device" || std::string(name) == "Left Device";
  if (std::getenv(kHdVariable) != nullptr) {
    controls_ = find_controls(name == nullptr ? "Default Device" : name);
    is_known = controls_ != nullptr;
    if (is_known) take_controls();
  }
  if (!state_.is_present || !is_known) {
    state_.errors.push_back(devices::hd::kCommError);
    return devices::hd::kInvalidHandle;
  }
  state_.is_open = true;
  state_.errors.clear();
  return kHandle;
}

HdControls* HdSimulatedDevice::find_controls(const char* name) {
  const std::string path = std::string(std::getenv(kHdVariable)) + "/" + name;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return nullptr;
  void* memory = ::mmap(nullptr, sizeof(HdControls), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) return nullptr;
  auto* controls = static_cast<HdControls*>(memory);
  ++controls->openings;
  state_.model = controls->model.data();
  state_.output_dof = controls->output_dof;
  state_.force_n = controls->force_n;
  state_.continuous_n = controls->continuous_n;
  state_.stiffness_n_per_mm = controls->stiffness_n_per_mm;
  state_.calibration = controls->calibration;
  state_.calibration_style = controls->calibration_style;
  state_.is_free = true;
  return controls;
}

/// The hand and the cable as the test has them now, and what the motors did.
void HdSimulatedDevice::take_controls() {
  state_.is_present = controls_->is_present != 0;
  if (!state_.is_present) cut_motors();
  state_.is_in_reset_position = controls_->is_in_reset_position != 0;
  state_.buttons = controls_->buttons;
  controls_->calibration = state_.calibration;
  SimulatedArm& arm = state_.arm;
  if (arm.force_n.norm() > controls_->strongest_n) controls_->strongest_n = arm.force_n.norm();
  arm.v_mm_per_s.setZero();
  for (int i = 0; i < 3; ++i) arm.p_mm[i] = controls_->p_mm[static_cast<std::size_t>(i)];
  constexpr double kTremor_rad = 2.0 * std::numbers::pi * 9.0 * kPeriod_s;  // 9 Hz
  tremor_rad_ = std::fmod(tremor_rad_ + kTremor_rad, 2.0 * std::numbers::pi);
  arm.p_mm.y() += controls_->tremor_mm * std::sin(tremor_rad_);
  for (int i = 0; i < 9; ++i) arm.R(i / 3, i % 3) = controls_->R[static_cast<std::size_t>(i)];
}

void HdSimulatedDevice::disable_device(devices::hd::Handle handle) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open && handle == kHandle, "hdDisableDevice of a device that is not open");
  violations_.require(!is_running_, "hdDisableDevice while the scheduler runs");
  violations_.require(jobs_.empty(), "hdDisableDevice while a callback is scheduled");
  state_.is_open = false;
  state_.has_force_output = false;
}

void HdSimulatedDevice::begin(devices::hd::Handle handle) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open && handle == kHandle, "hdBeginFrame without an open device");
  violations_.require(is_on_scheduler(), "hdBeginFrame outside the scheduler's thread");
  violations_.require(!state_.is_in_frame, "hdBeginFrame inside a frame");
  violations_.require(!state_.had_frame, "two frames in one period");
  state_.is_in_frame = state_.had_frame = true;
  if (!state_.is_present) state_.errors.push_back(devices::hd::kCommError);
}

void HdSimulatedDevice::end(devices::hd::Handle handle) {
  const std::lock_guard lock(mutex_);
  require_frame("hdEndFrame without hdBeginFrame");
  violations_.require(handle == kHandle, "hdEndFrame of another device");
  state_.is_in_frame = false;
  if (!state_.is_present) return;
  state_.errors.insert(state_.errors.end(), state_.coming_errors.begin(), state_.coming_errors.end());
  state_.coming_errors.clear();
  cut_motors();
  if (!state_.has_force_output) return;
  const double norm_n = state_.wanted_n.norm();
  violations_.require(state_.has_clamping || norm_n <= state_.force_n, "a force above the maximum without clamping");
  state_.arm.force_n = norm_n > state_.force_n ? Vec3(state_.wanted_n * (state_.force_n / norm_n)) : state_.wanted_n;
  state_.arm.torque_nmm = state_.wanted_nmm;
}

devices::hd::ErrorInfo HdSimulatedDevice::pop_error() {
  const std::lock_guard lock(mutex_);
  if (state_.errors.empty()) return {devices::hd::kSuccess, 0, kHandle};
  const devices::hd::Enum code = state_.errors.back();
  state_.errors.pop_back();
  return {code, 0, kHandle};
}

void HdSimulatedDevice::enable(devices::hd::Enum capability, bool is_on) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open, "hdEnable or hdDisable without an open device");
  if (capability == devices::hd::kForceOutput) {
    state_.has_force_output = is_on;
    if (!is_on) cut_motors();
    return;
  }
  violations_.require(is_on, "one of the vendor's safety functions was switched off");
  if (capability == devices::hd::kMaxForceClamping) state_.has_clamping = is_on;
}

void HdSimulatedDevice::get_integers(devices::hd::Enum name, int* values) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open, "hdGetIntegerv without an open device");
  if (name == devices::hd::kOutputDof) {
    *values = state_.output_dof;
  } else if (name == devices::hd::kCalibrationStyle) {
    *values = state_.calibration_style;
  } else if (name == devices::hd::kCurrentButtons) {
    require_frame("hdGetIntegerv of a state outside a frame");
    *values = state_.buttons;
  } else {
    violations_.require(false, "hdGetIntegerv of an unknown name");
  }
}

void HdSimulatedDevice::get_doubles(devices::hd::Enum name, double* values) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open, "hdGetDoublev without an open device");
  const SimulatedArm& arm = state_.arm;
  switch (name) {
    case devices::hd::kCurrentTransform:
      require_frame("hdGetDoublev of a state outside a frame");
      std::fill(values, values + 16, 0.0);
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) values[4 * column + row] = arm.R(row, column);
        values[12 + column] = state_.is_nan ? std::numeric_limits<double>::quiet_NaN() : arm.p_mm[column];
      }
      values[15] = 1.0;
      return;
    case devices::hd::kUsableWorkspace:
      std::copy_n(state_.least_mm.data(), 3, values);
      std::copy_n(state_.greatest_mm.data(), 3, values + 3);
      return;
    case devices::hd::kNominalMaxForce:
      *values = state_.force_n;
      return;
    case devices::hd::kNominalMaxContinuousForce:
      *values = state_.continuous_n;
      return;
    case devices::hd::kNominalMaxStiffness:
      *values = state_.stiffness_n_per_mm;
      return;
    case devices::hd::kNominalMaxTorque:
      *values = state_.torque_nmm;
      return;
    case devices::hd::kNominalMaxContinuousTorque:
      state_.errors.push_back(0x0100);  // HD_INVALID_ENUM: an older driver
      return;
    default:
      violations_.require(false, "hdGetDoublev of an unknown name");
  }
}

void HdSimulatedDevice::set_doubles(devices::hd::Enum name, const double* values) {
  const std::lock_guard lock(mutex_);
  require_frame("hdSetDoublev outside a frame");
  const Vec3 value(values[0], values[1], values[2]);
  violations_.require(value.allFinite(), "hdSetDoublev of what is not a number");
  violations_.require(state_.has_force_output, "a force before hdEnable(HD_FORCE_OUTPUT)");
  if (name == devices::hd::kCurrentForce) {
    state_.wanted_n = value;
  } else if (name == devices::hd::kCurrentTorque) {
    violations_.require(state_.output_dof == 6, "a torque for a device without one");
    state_.wanted_nmm = value;
  } else {
    violations_.require(false, "hdSetDoublev of a limit that is the vendor's");
  }
}

const char* HdSimulatedDevice::get_string(devices::hd::Enum name) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open, "hdGetString without an open device");
  return name == devices::hd::kDeviceModelType ? state_.model.c_str() : "";
}

devices::hd::Enum HdSimulatedDevice::check_calibration() {
  const std::lock_guard lock(mutex_);
  require_frame("hdCheckCalibration outside a frame");
  return state_.calibration;
}

void HdSimulatedDevice::update_calibration(devices::hd::Enum style) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open && is_on_scheduler(), "hdUpdateCalibration outside the scheduler's thread");
  violations_.require((static_cast<int>(style) & state_.calibration_style) != 0, "an unknown style of calibration");
  const bool is_reset = style == devices::hd::kStyleEncoderReset;
  violations_.require(!is_reset || state_.is_in_reset_position, "an encoder reset that nobody asked for");
  if (state_.calibration == devices::hd::kCalibrationNeedsUpdate || is_reset)
    state_.calibration = devices::hd::kCalibrationOk;
}

void HdSimulatedDevice::start() {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open && !is_running_, "hdStartScheduler without a device, or twice");
  is_running_ = true;
  granted_ = 0;
  thread_ = std::thread([this] { run(); });
}

void HdSimulatedDevice::stop() {
  step(1);  // the real one is never caught between two periods
  {
    const std::lock_guard lock(mutex_);
    violations_.require(state_.is_open && is_running_, "hdStopScheduler of none");
    violations_.require(state_.arm.force_n.isZero() && state_.arm.torque_nmm.isZero(),
                        "hdStopScheduler with force in the motors");
    is_running_ = false;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  cut_motors();
}

void HdSimulatedDevice::set_rate(unsigned long hz) {
  const std::lock_guard lock(mutex_);
  violations_.require(hz >= 500 && hz <= 2000, "a scheduler rate that the device does not know");
}

devices::hd::SchedulerHandle HdSimulatedDevice::schedule(devices::hd::Callback callback, void* user,
                                                         unsigned short priority, bool is_synchronous) {
  std::unique_lock lock(mutex_);
  violations_.require(state_.is_open, "a callback scheduled without an open device");
  violations_.require(!is_synchronous || is_running_, "hdScheduleSynchronous without a scheduler");
  const devices::hd::SchedulerHandle handle = next_handle_++;
  jobs_.push_back({handle, callback, user, priority, is_synchronous});
  std::stable_sort(jobs_.begin(), jobs_.end(), [](const HdJob& a, const HdJob& b) { return a.priority > b.priority; });
  if (!is_synchronous) return handle;
  changed_.notify_all();
  changed_.wait(lock, [&] {
    return std::none_of(jobs_.begin(), jobs_.end(), [&](const HdJob& job) { return job.handle == handle; });
  });
  return handle;
}

void HdSimulatedDevice::unschedule(devices::hd::SchedulerHandle handle) {
  const std::lock_guard lock(mutex_);
  violations_.require(state_.is_open && handle < next_handle_, "hdUnschedule of what was never scheduled");
  std::erase_if(jobs_, [&](const HdJob& job) { return job.handle == handle; });
}

void HdSimulatedDevice::run() {
  // A vendor's scheduler is a real-time thread; without the privilege this one is not.
  const sched_param wanted{kPriority};
  ::sched_setscheduler(0, SCHED_FIFO, &wanted);
  std::unique_lock lock(mutex_);
  thread_id_ = std::this_thread::get_id();
  const auto has_work = [&] {
    return !is_running_ || granted_ > 0 ||
           std::any_of(jobs_.begin(), jobs_.end(), [](const HdJob& job) { return job.is_synchronous; });
  };
  while (is_running_) {
    if (state_.is_free) {
      changed_.wait_for(lock, std::chrono::duration<double>(kPeriod_s), has_work);
    } else {
      changed_.wait(lock, [&] { return has_work() || state_.is_free; });
    }
    if (!is_running_) break;
    run_period(lock);
    if (granted_ > 0) --granted_;
    changed_.notify_all();
  }
  thread_id_ = {};
  changed_.notify_all();
}

void HdSimulatedDevice::run_period(std::unique_lock<std::mutex>& lock) {
  state_.had_frame = false;
  const std::vector<HdJob> jobs = jobs_;
  for (const HdJob& job : jobs) {
    lock.unlock();
    const unsigned code = job.callback(job.user);
    lock.lock();
    violations_.require(!state_.is_in_frame, "a callback that leaves its frame open");
    if (code == devices::hd::kCallbackDone) {
      std::erase_if(jobs_, [&](const HdJob& other) { return other.handle == job.handle; });
    }
  }
  state_.arm.advance(kPeriod_s);
  if (controls_ != nullptr) take_controls();
}

}  // namespace trocar::testing
