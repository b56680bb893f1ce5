// A stand-in for libdhd.so: a device that answers, and a mass that the force moves. It keeps the calling rules of the
// DHD library as its manual states them, and notes each one that is broken.
#include <array>
#include <limits>
#include <mutex>

#include "devices/test/standin/dhd_stand_in.h"
#include "devices/test/standin/violations.h"
#include "devices/vendor/detail/dhd_api.h"

namespace trocar::testing {
namespace {

constexpr int kFailed = -1;
constexpr char kId = 0;
constexpr double kMmPerM = 1000.0;
constexpr double kPeriod_s = 0.0005;  // of a force command
constexpr int kStatusCount = 17;
constexpr unsigned kFactoryVelocity = 30;

struct State {
  SimulatedArm arm;
  int type = devices::dhd::kOmega6;
  std::string name = "omega.6";
  bool has_active_wrist = false;
  bool is_present = true;
  bool is_open = false;
  bool is_calibrated = true;
  bool is_nan = false;
  bool is_early = false;
  bool has_force = false;
  bool has_gravity_compensation = false;
  bool is_expert = false;
  int force_off_cause = 0;
  unsigned char watchdog = 200;
  std::array<bool, 2> buttons{};
};

class Device final : public DhdStandIn {
 public:
  void reset() override {
    change([](State& state) { state = State(); });
    const std::lock_guard lock(mutex_);
    violations_.clear();
  }
  void set_type(int type, const char* name, bool has_active_wrist) override {
    change([=](State& state) {
      state.type = type;
      state.name = name;
      state.has_active_wrist = has_active_wrist;
    });
  }
  void set_present(bool is_present) override {
    change([=](State& state) {
      state.is_present = is_present;
      if (!is_present) cut_motors(state);
    });
  }
  void set_calibrated(bool is_calibrated) override {
    change([=](State& state) { state.is_calibrated = is_calibrated; });
  }
  void set_watchdog(unsigned char counts) override {
    change([=](State& state) { state.watchdog = counts; });
  }
  void set_pose(const Mat3& R, const Vec3& p_mm) override {
    change([&](State& state) {
      state.arm.R = R;
      state.arm.p_mm = p_mm;
      state.arm.v_mm_per_s.setZero();
    });
  }
  void set_button(int index, bool is_down) override {
    change([=](State& state) { state.buttons.at(static_cast<std::size_t>(index)) = is_down; });
  }
  void send_nan(bool is_nan) override {
    change([=](State& state) { state.is_nan = is_nan; });
  }
  void answer_time_guard(bool is_early) override {
    change([=](State& state) { state.is_early = is_early; });
  }
  void force_off(int cause) override {
    change([=](State& state) {
      state.force_off_cause = cause;
      state.has_force = cause == 0;
      cut_motors(state);
    });
  }
  SimulatedArm arm() const override { return now().arm; }
  bool is_open() const override { return now().is_open; }
  bool has_force() const override { return now().has_force; }
  bool has_gravity_compensation() const override { return now().has_gravity_compensation; }
  unsigned char watchdog() const override { return now().watchdog; }
  std::string violations() const override {
    const std::lock_guard lock(mutex_);
    return violations_.text();
  }

  /// A vendor's call: its rule, and what it does where the device answers.
  template <class Action>
  int call(char id, const char* rule, Action action) {
    const std::lock_guard lock(mutex_);
    violations_.require(state_.is_open && id == kId, rule);
    if (!state_.is_open || !state_.is_present) return kFailed;
    return action(state_, violations_);
  }
  int open() {
    const std::lock_guard lock(mutex_);
    violations_.require(!state_.is_open, "dhdOpen of a device that is open");
    if (!state_.is_present) return kFailed;
    state_.is_open = true;
    return kId;
  }
  int close(char id) {
    const std::lock_guard lock(mutex_);
    violations_.require(state_.is_open && id == kId, "dhdClose without an open device");
    violations_.require(!state_.is_present || !state_.has_force, "dhdClose with the motors on");
    violations_.require(!state_.is_expert, "dhdClose in expert mode");
    violations_.require(state_.watchdog > 0, "the vendor's watchdog was off");
    state_.is_open = state_.has_force = false;
    cut_motors(state_);
    return devices::dhd::kNoError;
  }
  int set_expert(bool is_expert) {
    change([=](State& state) { state.is_expert = is_expert; });
    return devices::dhd::kNoError;
  }
  const char* name() {
    const std::lock_guard lock(mutex_);
    return state_.name.c_str();
  }

  static void cut_motors(State& state) {
    state.arm.force_n.setZero();
    state.arm.torque_nmm.setZero();
  }

 private:
  template <class Change>
  void change(Change change_state) {
    const std::lock_guard lock(mutex_);
    change_state(state_);
  }
  State now() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }

  mutable std::mutex mutex_;
  State state_;
  Violations violations_;
};

Device& device() {
  static Device the_device;
  return the_device;
}

int set_wrench(State& state, Violations& violations, const Vec3& force_n, const Vec3& torque_nm) {
  violations.require(force_n.allFinite() && torque_nm.allFinite(), "a force that is not a number");
  violations.require(state.has_force || state.force_off_cause != 0, "a force before dhdEnableForce");
  violations.require(state.has_active_wrist || torque_nm.isZero(), "a torque for a device without one");
  violations.require(state.watchdog > 0, "a force without the vendor's watchdog");
  violations.require(state.has_gravity_compensation, "a force without gravity compensation");
  Device::cut_motors(state);
  if (state.has_force) {
    state.arm.force_n = force_n;
    state.arm.torque_nmm = kMmPerM * torque_nm;
  }
  state.arm.advance(kPeriod_s);
  return devices::dhd::kNoError;
}

int get_pose(const State& state, double* x, double* y, double* z, double (*rows)[3]) {
  const Vec3 p_m = state.arm.p_mm / kMmPerM;
  *x = state.is_nan ? std::numeric_limits<double>::quiet_NaN() : p_m.x();
  *y = p_m.y();
  *z = p_m.z();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows[row][column] = state.arm.R(row, column);
  }
  return state.is_early ? devices::dhd::kTimeGuard : devices::dhd::kNoError;
}

}  // namespace
}  // namespace trocar::testing

namespace dhd = trocar::devices::dhd;
using trocar::Vec3;
using trocar::testing::device;
using trocar::testing::State;
using trocar::testing::Violations;

extern "C" {
trocar::testing::DhdStandIn* trocar_dhd_stand_in() {
  return &device();
}
int dhdOpen() {
  return device().open();
}
int dhdClose(char id) {
  return device().close(id);
}
int dhdGetSystemType(char id) {
  return device().call(id, "dhdGetSystemType without a device", [](State& state, Violations&) { return state.type; });
}
const char* dhdGetSystemName(char) {
  return device().name();
}
int dhdEnableForce(unsigned char on, char id) {
  return device().call(id, "dhdEnableForce without a device", [=](State& state, Violations&) {
    state.has_force = on != 0 && state.force_off_cause == 0;
    if (!state.has_force) trocar::testing::Device::cut_motors(state);
    return trocar::devices::dhd::kNoError;
  });
}
int dhdGetStatus(int* status, char id) {
  return device().call(id, "dhdGetStatus without a device", [=](State& state, Violations&) {
    for (int i = 0; i < trocar::testing::kStatusCount; ++i) status[i] = 0;
    status[trocar::devices::dhd::kStatusPower] = 1;
    status[trocar::devices::dhd::kStatusReset] = state.is_calibrated ? 0 : 1;
    status[trocar::devices::dhd::kStatusForce] = state.has_force ? 1 : 0;
    status[trocar::devices::dhd::kStatusForceOffCause] = state.force_off_cause;
    return trocar::devices::dhd::kNoError;
  });
}
int dhdSetGravityCompensation(int on, char id) {
  return device().call(id, "dhdSetGravityCompensation without a device", [=](State& state, Violations&) {
    state.has_gravity_compensation = on != 0;
    return trocar::devices::dhd::kNoError;
  });
}
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double (*rows)[3], char id) {
  return device().call(id, "a read without a device",
                       [=](State& state, Violations&) { return trocar::testing::get_pose(state, x, y, z, rows); });
}
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double grip,
                                        char id) {
  return device().call(id, "a force without a device", [=](State& state, Violations& violations) {
    violations.require(grip == 0.0, "a force for the gripper");
    return trocar::testing::set_wrench(state, violations, {fx, fy, fz}, {tx, ty, tz});
  });
}
int dhdGetButton(int index, char id) {
  return device().call(id, "dhdGetButton without a device", [=](State& state, Violations& violations) {
    violations.require(index >= 0 && index < 16, "a button that no device has");
    return index < 2 && state.buttons.at(static_cast<std::size_t>(index)) ? 1 : 0;
  });
}
const char* dhdErrorGetLastStr() {
  return "no device found";
}
int dhdGetWatchdog(unsigned char* counts, char id) {
  return device().call(id, "dhdGetWatchdog without a device", [=](State& state, Violations&) {
    *counts = state.watchdog;
    return trocar::devices::dhd::kNoError;
  });
}
int dhdSetWatchdog(unsigned char counts, char id) {
  return device().call(id, "dhdSetWatchdog without a device", [=](State& state, Violations& violations) {
    violations.require(counts > 0, "the vendor's watchdog was switched off");
    violations.require(state.is_expert, "an expert's function outside expert mode");
    state.watchdog = counts;
    return trocar::devices::dhd::kNoError;
  });
}
int dhdEnableExpertMode() {
  return device().set_expert(true);
}
int dhdDisableExpertMode() {
  return device().set_expert(false);
}
int dhdSetVelocityThreshold(unsigned threshold, char id) {
  return device().call(id, "dhdSetVelocityThreshold without a device", [=](State&, Violations& violations) {
    violations.require(threshold <= trocar::testing::kFactoryVelocity, "the velocity brake was loosened");
    return trocar::devices::dhd::kNoError;
  });
}
int dhdEmulateButton(unsigned char, char id) {
  return device().call(id, "dhdEmulateButton without a device", [](State&, Violations& violations) {
    violations.require(false, "the force button was pressed by the program");
    return trocar::devices::dhd::kNoError;
  });
}
}
