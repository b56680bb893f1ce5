// A servo on the adapters of real devices, against their stand-ins, when they break: the force ends and stays away, no
// limit is exceeded, and no calling rule of a vendor is broken on the way.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "devices/device_spec.h"
#include "devices/test/standin/dhd_stand_in.h"
#include "devices/test/standin/hd_stand_in.h"
#include "devices/testing/haply_service.h"
#include "devices/testing/spacenav_daemon.h"
#include "devices/vendor/test/vendor_library.h"
#include "realtime/periodic_loop.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

/// What stands for the hardware of a kind, while it lives; and what it found broken.
class Hardware {
 public:
  explicit Hardware(const std::string& kind) {
    if (kind == "openhaptics") {
      hd_ = testing::use_stand_in<testing::HdStandIn>("TROCAR_LIBHD", "libHD.so", "trocar_hd_stand_in");
      hd_->reset();
      hd_->run_freely(true);
    } else if (kind == "forcedimension") {
      dhd_ = testing::use_stand_in<testing::DhdStandIn>("TROCAR_LIBDHD", "libdhd.so", "trocar_dhd_stand_in");
      dhd_->reset();
    } else if (kind == "haply") {
      haply_ = std::make_unique<testing::HaplyService>();
    } else {
      spacenav_ = std::make_unique<testing::SpacenavDaemon>();
    }
  }
  std::string spec(const std::string& kind) const { return haply_ ? kind + ":" + haply_->address() : kind; }
  std::string violations() const {
    if (hd_ != nullptr) return hd_->violations();
    if (dhd_ != nullptr) return dhd_->violations();
    std::string all;
    if (haply_) {
      for (const std::string& violation : haply_->violations()) all += violation + "; ";
    }
    return all;
  }

 private:
  testing::HdStandIn* hd_ = nullptr;
  testing::DhdStandIn* dhd_ = nullptr;
  std::unique_ptr<testing::HaplyService> haply_;
  std::unique_ptr<testing::SpacenavDaemon> spacenav_;
};

/// The layered patient comes to the needle, wherever the device holds it.
class ApproachingPatient {
 public:
  explicit ApproachingPatient(const stylus::DevicePreset& preset)
      : builder_(testing::layered_opener(), testing::data_file("tissues.toml"), preset) {
    auto made = builder_.load(testing::layered_request());
    TROCAR_CHECK(made.has_value());
    scene_ = *made;
  }
  /// The tip of a needle with its stylus there (in the room) is so deep below the skin.
  const ServoScene* at(const Pose& X_WS, double depth_mm) {
    auto scene = std::make_shared<haptics::HapticScene>(*scene_.scene);
    const Pose X_WN = X_WS * scene->X_SN;
    scene->X_PW = needle_pose({0.0, 0.0, depth_mm}, Vec3::UnitZ()) * X_WN.inverse();
    scene_ = {std::move(scene), scene_.number + 1, true};
    return &scene_;
  }

 private:
  SceneBuilder builder_;
  ServoScene scene_;
};

struct VendorFault {
  const char* kind;
  const char* schedule;
  telemetry::GateFault fault;
};

class VendorFaults : public ::testing::TestWithParam<VendorFault> {};

/// What a device that breaks at kScheduledFault_s led to.
struct Trial {
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  double broken_s =
      0.0;  ///< 0: the fault came before its time, from a loaded machine that starved the device's thread.
  double last_force_s = 0.0;
  double most_n = 0.0;
  std::string violations;
};

constexpr double kOn_s = 0.9;              // past the safe start
constexpr double kScheduledFault_s = 1.2;  // as the schedules say
constexpr double kSilent_s = 0.5;          // a loaded machine may keep a device's thread waiting for some time

void run_trial(const VendorFault& expected, Trial& trial) {
  const Hardware hardware(expected.kind);
  {
    devices::DeviceOptions options;
    options.devices_file = testing::data_file("devices.toml");
    options.faults = {*devices::parse_fault(expected.schedule)};
    auto device = devices::open_device(*devices::parse_device_spec(hardware.spec(expected.kind)), options);
    ASSERT_TRUE(device) << device.error().text();
    const stylus::DevicePreset& preset = (*device)->preset();
    ServoParams params = servo_params(preset);
    params.gate.max_unread_s = kSilent_s;
    params.max_hole_s = 10.0;
    Servo servo(**device, params);
    ApproachingPatient patient(preset);

    ServoRecord record;
    const double end_s =
        kScheduledFault_s + (expected.fault == telemetry::GateFault::kDeviceSilent ? kSilent_s : 0.0) + 0.3;
    constexpr double kCountedPeriod_s =
        1e-3;  // the servo's time is counted: a hole of the machine must look like no plunge
    for (double time_s = 0.0; time_s < end_s;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      time_s += kCountedPeriod_s;
      ServoInput input;
      input.now_s = time_s;
      input.dt_s = kCountedPeriod_s;
      input.is_wanted = true;
      if (trial.broken_s == 0.0 && time_s >= kScheduledFault_s) trial.broken_s = time_s;
      const double depth_mm = std::min(3.0, -10.0 + std::max(0.0, time_s - kOn_s) * 60.0);
      const Pose X_WS =
          preset.sensed_dof == 6 ? record.X_DS : Pose(rotation_between(Vec3::UnitZ(), -Vec3::UnitZ()), record.X_DS.p());
      input.scene = patient.at(params.workspace.X_WD * X_WS, depth_mm);
      record = servo.step(input);
      trial.fault = record.sample.gate_fault;
      if (trial.broken_s == 0.0 && record.sample.gate_fault != telemetry::GateFault::kNone) break;
      const double written_n = record.written_D.force_n.norm();
      trial.most_n = std::max(trial.most_n, written_n);
      if (written_n > 0.0) trial.last_force_s = time_s;
      ASSERT_LE(written_n, preset.capability.peak_force_n + 1e-9);
    }
  }
  trial.violations = hardware.violations();
}

TEST_P(VendorFaults, EndAtZeroForceWithoutRuleViolations) {
  const VendorFault& expected = GetParam();
  Trial trial;
  for (int attempt = 0; attempt < 10 && trial.broken_s == 0.0; ++attempt) {
    trial = {};
    ASSERT_NO_FATAL_FAILURE(run_trial(expected, trial));
  }
  ASSERT_GT(trial.broken_s, 0.0) << "the device broke before its time: " << to_string(trial.fault);
  EXPECT_GT(trial.most_n, 0.1) << "there was something to be felt before";
  EXPECT_STREQ(to_string(trial.fault), to_string(expected.fault));
  constexpr double kRamp_s = 0.05;  // the gate's 20 ms, and a period of a loaded machine
  EXPECT_LE(
      trial.last_force_s,
      trial.broken_s + kRamp_s + (expected.fault == telemetry::GateFault::kDeviceSilent ? kSilent_s + kRamp_s : 0.0));
  EXPECT_EQ(trial.violations, "");
}

std::vector<VendorFault> all_vendor_faults() {
  std::vector<VendorFault> faults;
  for (const char* kind : {"openhaptics", "forcedimension", "haply", "spacemouse"}) {
    faults.push_back({kind, "nan@1.2", telemetry::GateFault::kNotFinite});
    faults.push_back({kind, "disconnect@1.2", telemetry::GateFault::kDeviceLost});
    faults.push_back({kind, "dropped@1.2", telemetry::GateFault::kDeviceSilent});
  }
  return faults;
}

INSTANTIATE_TEST_SUITE_P(Devices, VendorFaults, ::testing::ValuesIn(all_vendor_faults()), [](const auto& param) {
  return std::string(param.param.kind) + "_" + to_string(param.param.fault);
});

}  // namespace
}  // namespace trocar::server
