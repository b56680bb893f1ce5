#include "devices/vendor/openhaptics_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/source_dir.h"
#include "devices/device_spec.h"
#include "devices/test/standin/hd_stand_in.h"
#include "devices/vendor/detail/hd_api.h"
#include "devices/vendor/detail/servo_exchange.h"
#include "devices/vendor/test/vendor_library.h"
#include "devices/workspace_map.h"

namespace trocar::devices {
namespace {

using testing::HdStandIn;
using testing::kTiny;

std::atomic<double> callback_now_s{0.0};
double callback_clock_s() noexcept {
  return callback_now_s.load();
}

class OpenHaptics : public ::testing::Test {
 protected:
  void SetUp() override {
    vendor = testing::use_stand_in<HdStandIn>("TROCAR_LIBHD", "libHD.so", "trocar_hd_stand_in");
    ASSERT_NE(vendor, nullptr);
    vendor->reset();
  }
  void TearDown() override {
    device.reset();
    EXPECT_FALSE(vendor->is_open());
    EXPECT_EQ(vendor->violations(), "");
    vendor->reset();
  }

  Status open(bool is_calibrating = false) {
    OpenHapticsOptions options;
    options.is_calibrating = is_calibrating;
    options.devices_file = testing::source_dir() / "data/devices.toml";
    options.clock_s = &callback_clock_s;
    options.stylus_folder = stylus_folder;
    auto opened = open_openhaptics_device(options);
    if (!opened) return tl::unexpected(opened.error());
    device = *std::move(opened);
    return {};
  }
  void open_or_fail() {
    const Status status = open();
    ASSERT_TRUE(status) << status.error().text();
  }
  DeviceReading read_after(int periods) {
    vendor->step(periods);
    return device->read(now_s += 0.001);
  }
  Vec3 force_after(const Vec3& force_D) {
    EXPECT_TRUE(device->write({force_D, Vec3::Zero()}));
    vendor->step(1);
    return vendor->arm().force_n;
  }

  HdStandIn* vendor = nullptr;
  std::unique_ptr<HapticDevice> device;
  std::filesystem::path stylus_folder;
  double now_s = 50.0;
};

TEST_F(OpenHaptics, MapsUpwardMotionToZ) {
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), {10, 20, 30});  // right, up, towards the user
  const DeviceReading reading = read_after(1);
  EXPECT_EQ(reading.status, DeviceStatus::kFresh);
  EXPECT_LT((reading.X_DS.p() - Vec3(10, -30, 20)).norm(), kTiny);
}

TEST_F(OpenHaptics, RotatesForceIntoDeviceAxes) {
  open_or_fail();
  EXPECT_LT((force_after({1, 0, 0}) - Vec3(1, 0, 0)).norm(), kTiny);
  EXPECT_LT((force_after({0, 1, 0}) - Vec3(0, 0, -1)).norm(), kTiny);
  EXPECT_LT((force_after({0, 0, 1}) - Vec3(0, 1, 0)).norm(), kTiny);
}

TEST_F(OpenHaptics, ForceAndPositionShareOneFrame) {
  open_or_fail();
  const Vec3 force_D(0.3, -0.4, 0.5);
  const Vec3 before = read_after(1).X_DS.p();
  ASSERT_TRUE(device->write({force_D, Vec3::Zero()}));
  const Vec3 moved = read_after(10).X_DS.p() - before;
  EXPECT_GT(moved.norm(), 0.1);
  EXPECT_NEAR(moved.normalized().dot(force_D.normalized()), 1.0, kTiny);
}

TEST_F(OpenHaptics, StylusPointsFromGripToTip) {
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), Vec3::Zero());  // its tail towards the user
  EXPECT_LT((read_after(1).X_DS.R().col(2) - Vec3(0, 1, 0)).norm(), kTiny);
  // A quarter turn about the vendor's y brings the tail to the right: the tip points left. Rows for columns would turn
  // it the other way.
  const Mat3 R = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  vendor->set_pose(R, Vec3::Zero());
  const Mat3 R_DS = read_after(1).X_DS.R();
  EXPECT_LT((R_DS.col(2) - Vec3(-1, 0, 0)).norm(), kTiny);
  EXPECT_NEAR(R_DS.determinant(), 1.0, kTiny);
}

TEST_F(OpenHaptics, PlacesTheOriginAtTheWorkspaceCentre) {
  vendor->set_workspace({-100, 0, -50}, {100, 200, 70});
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), {0, 100, 10});
  EXPECT_LT(read_after(1).X_DS.p().norm(), kTiny);
}

TEST_F(OpenHaptics, FirstReadingComesFromTheDevice) {
  vendor->set_pose(Mat3::Identity(), {1, 2, 3});
  open_or_fail();
  const DeviceReading reading = device->read(now_s);
  EXPECT_NE(reading.status, DeviceStatus::kDisconnected);
  EXPECT_LT((reading.X_DS.p() - Vec3(1, -3, 2)).norm(), kTiny);
}

TEST_F(OpenHaptics, MarksAReadWithinOnePeriodAsRepeated) {
  open_or_fail();
  vendor->step(1);
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kFresh);
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kRepeated);
}

TEST_F(OpenHaptics, ReportsButtonsAsBits) {
  open_or_fail();
  for (const int bits : {0, hd::kButton1, hd::kButton2, hd::kButton1 | hd::kButton2}) {
    vendor->set_buttons(bits);
    const std::uint32_t expected =
        ((bits & hd::kButton1) != 0 ? kButtonMain : 0u) | ((bits & hd::kButton2) != 0 ? kButtonSecond : 0u);
    EXPECT_EQ(read_after(1).buttons, expected);
  }
}

TEST_F(OpenHaptics, ModelChoosesThePreset) {
  const std::pair<const char*, const char*> rows[] = {{"PHANTOM Omni", "omni"},
                                                      {"Touch", "omni"},
                                                      {"Touch X", "desktop"},
                                                      {"PHANTOM Desktop", "desktop"},
                                                      {"PHANTOM Premium 1.5 6DOF", "premium"}};
  for (const auto& [model, preset] : rows) {
    vendor->set_model(model, 3);
    open_or_fail();
    EXPECT_EQ(device->preset().name, preset) << model;
    device.reset();
  }
  vendor->set_model("Falcon", 3);
  const Status unknown = open();
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text().find("Falcon"), std::string::npos);
}

TEST_F(OpenHaptics, AppliesASavedWeight) {
  const TemporaryFolder folder;
  stylus_folder = folder.path();
  vendor->set_model("PHANTOM Omni", 3);
  ASSERT_TRUE(save_stylus_profile({"openhaptics", "omni", 0.7, std::nullopt}, stylus_folder));
  open_or_fail();
  EXPECT_EQ(device->preset().capability.stylus_weight_n, 0.7);
  device.reset();
  vendor->set_model("PHANTOM Premium 1.5 6DOF", 6);
  const Status other = open();
  ASSERT_FALSE(other) << "the default device is another one now";
  EXPECT_NE(other.error().text().find("premium"), std::string::npos);
}

TEST_F(OpenHaptics, DeviceLimitsTightenThePreset) {
  vendor->set_model("PHANTOM Premium 1.5 6DOF", 6);
  vendor->set_nominal(8.5, 1.4, 0.25, 188.0);
  open_or_fail();
  const stylus::DevicePreset& preset = device->preset();
  EXPECT_DOUBLE_EQ(preset.capability.peak_force_n, 8.5);
  EXPECT_DOUBLE_EQ(preset.continuous_force_n.value(), 1.4);
  EXPECT_DOUBLE_EQ(preset.capability.max_stiffness_n_per_mm, 0.25);
  EXPECT_DOUBLE_EQ(preset.capability.peak_torque_nmm, 188.0);
  EXPECT_LE(preset.coupling.stiffness_n_per_mm, 0.25);
  device.reset();

  vendor->set_nominal(1000.0, std::nan(""), -1.0, std::numeric_limits<double>::infinity());
  open_or_fail();
  EXPECT_DOUBLE_EQ(device->preset().capability.peak_force_n, 37.5);
  EXPECT_DOUBLE_EQ(device->preset().continuous_force_n.value(), 6.2);
  EXPECT_DOUBLE_EQ(device->preset().capability.max_stiffness_n_per_mm, 3.5);
}

TEST_F(OpenHaptics, SendsTorqueOnlyToSixDegreeOfFreedomDevices) {
  open_or_fail();  // an Omni: the stand-in notes a torque for it
  EXPECT_FALSE(device->preset().has_torque());
  EXPECT_TRUE(device->write({Vec3(0, 0, 1), Vec3(10, 20, 30)}));
  vendor->step(1);
  device.reset();

  vendor->set_model("PHANTOM Premium 1.5 6DOF", 6);
  vendor->set_nominal(8.5, 1.4, 1.0, 188.0);
  open_or_fail();
  EXPECT_TRUE(device->write({Vec3(0, 0, 1), Vec3(10, 20, 30)}));
  vendor->step(1);
  EXPECT_LT((vendor->arm().torque_nmm - Vec3(10, 30, -20)).norm(), kTiny);
}

TEST_F(OpenHaptics, ClampsForceToThePeak) {
  open_or_fail();
  const double peak_n = device->preset().capability.peak_force_n;
  EXPECT_NEAR(force_after({0, 0, 5 * peak_n}).norm(), peak_n, kTiny);
  EXPECT_FALSE(device->write({Vec3(0, 0, 1e6), Vec3::Zero()})) << "no gate writes that";
  vendor->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
}

TEST_F(OpenHaptics, ZeroesAStaleWrench) {
  open_or_fail();
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
  callback_now_s.store(callback_now_s.load() + 0.9 * ServoExchange::kOldestWrench_s);
  vendor->step(1);
  EXPECT_GT(vendor->arm().force_n.norm(), 0.9);
  callback_now_s.store(callback_now_s.load() + 0.2 * ServoExchange::kOldestWrench_s);
  vendor->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
}

TEST_F(OpenHaptics, RefusesANanWrenchAndZeroesTheForce) {
  open_or_fail();
  force_after({0, 0, 1});
  EXPECT_FALSE(device->write({Vec3(0, std::nan(""), 1), Vec3::Zero()}));
  vendor->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
}

TEST_F(OpenHaptics, PassesANanPoseAndZeroesTheForce) {
  open_or_fail();
  force_after({0, 0, 1});
  vendor->send_nan(true);
  device->write({Vec3(0, 0, 1), Vec3::Zero()});
  EXPECT_FALSE(read_after(1).X_DS.is_finite());
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  vendor->send_nan(false);
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
  EXPECT_TRUE(device->read(now_s).X_DS.is_finite());
}

TEST_F(OpenHaptics, RefusesWritesAfterAForceError) {
  open_or_fail();
  for (const hd::Enum code : {hd::kWarmMotors, hd::kExceededMaxForce, hd::kForceError}) {
    vendor->push_error(code);
    EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
    EXPECT_FALSE(device->write(Wrench{}));
    EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
    EXPECT_TRUE(device->write(Wrench{}));
  }
}

TEST_F(OpenHaptics, StaysDisconnectedUntilReconnected) {
  open_or_fail();
  force_after({0, 0, 1});
  vendor->set_present(false);
  EXPECT_EQ(read_after(1).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(device->write({Vec3(0, 0, 1), Vec3::Zero()}));
  const Status gone = device->reconnect();
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().text().find("Communication error"), std::string::npos) << gone.error().text();
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(device->write(Wrench{}));

  vendor->set_present(true);
  const Status back = device->reconnect();
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
}

TEST_F(OpenHaptics, AnotherModelAfterReconnectIsRefused) {
  open_or_fail();
  vendor->set_model("PHANTOM Premium 1.5 6DOF", 6);
  EXPECT_FALSE(device->reconnect());
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kDisconnected);
}

TEST_F(OpenHaptics, SchedulerThatHangsIsDisconnected) {
  open_or_fail();
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  int reads = 0;
  while (device->read(now_s += 0.001).status != DeviceStatus::kDisconnected && reads < 1000) ++reads;
  EXPECT_NEAR(reads, 1000 * ServoExchange::kLongestSilence_s, 2);
  vendor->step(1);
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kDisconnected) << "until it is opened again";
}

TEST_F(OpenHaptics, SurvivesASuspendedProcess) {
  open_or_fail();
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  EXPECT_EQ(device->read(now_s += 10.0).status, DeviceStatus::kRepeated);
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
}

TEST_F(OpenHaptics, ZeroesTheForceWhenClosed) {
  open_or_fail();
  EXPECT_GT(force_after({0, 0, 2}).norm(), 1.9);
  device.reset();
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_FALSE(vendor->has_force_output());
}

TEST_F(OpenHaptics, ReportsAMissingLibrary) {
  setenv("TROCAR_LIBHD", "/nowhere/libHD.so", 1);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().exit_status, 1);
  for (const char* word : {"OpenHaptics", "/nowhere/libHD.so", "TROCAR_LIBHD", "driver"}) {
    EXPECT_NE(status.error().text().find(word), std::string::npos) << status.error().text();
  }
}

TEST_F(OpenHaptics, ReportsAForeignLibrary) {
  setenv("TROCAR_LIBHD", (testing::standin_dir() / "libdhd.so").c_str(), 1);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("hdInitDevice"), std::string::npos) << status.error().text();
}

TEST_F(OpenHaptics, ReportsAMissingDevice) {
  vendor->set_present(false);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("no OpenHaptics device \"default device\""), std::string::npos);
  EXPECT_NE(status.error().text().find("connect"), std::string::npos);
}

TEST_F(OpenHaptics, ReportsAnUncalibratedDeviceWithoutMovingIt) {
  vendor->set_calibration(hd::kCalibrationNeedsManualInput, hd::kStyleInkwell);
  Status status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("inkwell"), std::string::npos) << status.error().text();
  vendor->set_calibration(hd::kCalibrationNeedsUpdate, hd::kStyleEncoderReset);
  status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("diagnostic"), std::string::npos) << status.error().text();
  vendor->set_calibration(hd::kCalibrationNeedsUpdate, hd::kStyleInkwell);
  open_or_fail();
}

TEST_F(OpenHaptics, CalibratesWhileTheArmIsHeld) {
  vendor->set_calibration(hd::kCalibrationNeedsManualInput, hd::kStyleEncoderReset);
  ASSERT_FALSE(open());
  vendor->hold_in_reset_position(true);
  const Status status = open(true);
  EXPECT_TRUE(status) << status.error().text();
  EXPECT_EQ(vendor->violations(), "");
}

TEST_F(OpenHaptics, SecondDeviceInOneProgramIsRefused) {
  open_or_fail();
  OpenHapticsOptions options;
  options.devices_file = testing::source_dir() / "data/devices.toml";
  const auto second = open_openhaptics_device(options);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("in use"), std::string::npos);
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
}

TEST_F(OpenHaptics, OpensByItsKindAndName) {
  DeviceOptions options;
  options.devices_file = testing::source_dir() / "data/devices.toml";
  auto opened = open_device({"openhaptics", "Left Device"}, options);
  ASSERT_TRUE(opened) << opened.error().text();
  device = *std::move(opened);
  EXPECT_EQ(device->name(), "openhaptics:Left Device");
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  device.reset();
  EXPECT_FALSE(open_device({"openhaptics", "No Such Device"}, options));
}

TEST_F(OpenHaptics, ReadAndWriteDoNotAllocate) {
  open_or_fail();
  vendor->step(1);
  testing::AllocationGuard guard;
  device->read(now_s);
  device->write({Vec3(0, 0, 1), Vec3(1, 0, 0)});
  device->write({Vec3(0, 0, std::nan("")), Vec3::Zero()});
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(OpenHaptics, RunsIndependentlyOfTheRealTimeThread) {
  open_or_fail();
  vendor->run_freely(true);
  int fresh = 0;
  while (fresh < 50) {
    const DeviceReading reading = device->read(now_s);
    ASSERT_NE(reading.status, DeviceStatus::kDisconnected);
    ASSERT_TRUE(reading.X_DS.is_finite());
    if (reading.status == DeviceStatus::kFresh) ++fresh;
    // No force: how far a free mass would run meanwhile is up to the machine's scheduling.
    ASSERT_TRUE(device->write({}));
    std::this_thread::yield();
  }
}

/// The witness itself: it notes what the tests above are clean of.
TEST_F(OpenHaptics, StandInRecordsRuleViolations) {
  const auto api = hd::load_api();
  ASSERT_TRUE(api);
  const auto broken = [&] {
    const std::string text = vendor->violations();
    vendor->reset();
    return text;
  };
  double values[16] = {};
  api->begin_frame(7);
  EXPECT_NE(broken().find("without an open device"), std::string::npos);
  api->init_device(nullptr);
  api->get_doublev(hd::kCurrentTransform, values);
  EXPECT_NE(broken().find("outside a frame"), std::string::npos);
  api->init_device(nullptr);
  api->begin_frame(7);
  EXPECT_NE(broken().find("scheduler's thread"), std::string::npos);
  api->init_device(nullptr);
  api->set_doublev(hd::kCurrentForce, values);
  EXPECT_NE(broken().find("before hdEnable"), std::string::npos);
  api->init_device(nullptr);
  api->disable(hd::kMaxForceClamping);
  EXPECT_NE(broken().find("safety"), std::string::npos);
}

}  // namespace
}  // namespace trocar::devices
