#include "devices/vendor/forcedimension_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "core/testing/allocation_guard.h"
#include "core/testing/no_threads.h"
#include "core/testing/source_dir.h"
#include "devices/device_spec.h"
#include "devices/test/standin/dhd_stand_in.h"
#include "devices/vendor/detail/dhd_api.h"
#include "devices/vendor/detail/servo_exchange.h"
#include "devices/vendor/test/stepped_pace.h"
#include "devices/vendor/test/vendor_library.h"

namespace trocar::devices {
namespace {

using testing::DhdStandIn;
using testing::kTiny;

constexpr int kPeriodsToNotice = 100;  // more than between two looks at the device's state

class ForceDimension : public ::testing::Test {
 protected:
  void SetUp() override {
    vendor = testing::use_stand_in<DhdStandIn>("TROCAR_LIBDHD", "libdhd.so", "trocar_dhd_stand_in");
    ASSERT_NE(vendor, nullptr);
    vendor->reset();
  }
  void TearDown() override {
    device.reset();
    EXPECT_FALSE(vendor->is_open());
    EXPECT_EQ(vendor->violations(), "");
    vendor->reset();
  }

  Status open() {
    ForceDimensionOptions options;
    options.devices_file = testing::source_dir() / "data/devices.toml";
    options.pace = pace;
    auto opened = open_forcedimension_device(options);
    if (!opened) return tl::unexpected(opened.error());
    device = *std::move(opened);
    return {};
  }
  void open_or_fail() {
    const Status status = open();
    ASSERT_TRUE(status) << status.error().text();
  }
  DeviceReading read_after(int periods) {
    pace->step(periods);
    return device->read(now_s += 0.001);
  }
  Vec3 force_after(const Vec3& force_D) {
    EXPECT_TRUE(device->write({force_D, Vec3::Zero()}));
    pace->step(1);
    return vendor->arm().force_n;
  }

  DhdStandIn* vendor = nullptr;
  std::shared_ptr<testing::SteppedPace> pace = std::make_shared<testing::SteppedPace>();
  std::unique_ptr<HapticDevice> device;
  double now_s = 50.0;
};

TEST_F(ForceDimension, ConvertsMetresAndAxes) {
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), {10, 20, 30});  // mm: towards the user, right, up
  const DeviceReading reading = read_after(1);
  EXPECT_EQ(reading.status, DeviceStatus::kFresh);
  EXPECT_LT((reading.X_DS.p() - Vec3(20, -10, 30)).norm(), kTiny);
}

TEST_F(ForceDimension, RotatesForceIntoDeviceAxes) {
  open_or_fail();
  EXPECT_LT((force_after({1, 0, 0}) - Vec3(0, 1, 0)).norm(), kTiny);
  EXPECT_LT((force_after({0, 1, 0}) - Vec3(-1, 0, 0)).norm(), kTiny);
  EXPECT_LT((force_after({0, 0, 1}) - Vec3(0, 0, 1)).norm(), kTiny);
}

TEST_F(ForceDimension, ForceAndPositionShareOneFrame) {
  open_or_fail();
  const Vec3 force_D(0.3, -0.4, 0.5);
  const Vec3 before = read_after(1).X_DS.p();
  ASSERT_TRUE(device->write({force_D, Vec3::Zero()}));
  const Vec3 moved = read_after(20).X_DS.p() - before;
  EXPECT_GT(moved.norm(), 0.1);
  EXPECT_NEAR(moved.normalized().dot(force_D.normalized()), 1.0, kTiny);
}

TEST_F(ForceDimension, StylusPointsFromGripToTip) {
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), Vec3::Zero());
  EXPECT_LT((read_after(1).X_DS.R().col(2) - Vec3(0, 1, 0)).norm(), kTiny);
  // A quarter turn about the vendor's z brings what pointed away (-x) to the left (-y).
  const Mat3 R = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()).toRotationMatrix();
  vendor->set_pose(R, Vec3::Zero());
  const Mat3 R_DS = read_after(1).X_DS.R();
  EXPECT_LT((R_DS.col(2) - Vec3(-1, 0, 0)).norm(), kTiny);
  EXPECT_NEAR(R_DS.determinant(), 1.0, kTiny);
}

TEST_F(ForceDimension, ReportsIdentityWithoutRotationSensors) {
  vendor->set_type(dhd::kFalcon, "Falcon", false);
  open_or_fail();
  vendor->set_pose(Mat3::Identity(), {1, 2, 3});
  EXPECT_TRUE(read_after(1).X_DS.R().isIdentity());
}

TEST_F(ForceDimension, ReportsButtonsAsBits) {
  open_or_fail();
  EXPECT_EQ(read_after(1).buttons, 0u);
  vendor->set_button(0, true);
  EXPECT_EQ(read_after(1).buttons, kButtonMain);
  vendor->set_button(1, true);
  EXPECT_EQ(read_after(1).buttons, kButtonMain | kButtonSecond);
}

TEST_F(ForceDimension, ModelChoosesThePreset) {
  const std::pair<int, const char*> rows[] = {
      {dhd::kOmega6, "omega6"}, {dhd::kOmega6Left, "omega6"}, {dhd::kOmega7, "omega7"}, {dhd::kOmega7Left, "omega7"},
      {dhd::kSigma7, "sigma7"}, {dhd::kSigma7Left, "sigma7"}, {dhd::kDelta6, "delta6"}, {dhd::kFalcon, "falcon"}};
  for (const auto& [type, preset] : rows) {
    vendor->set_type(type, preset, false);
    open_or_fail();
    EXPECT_EQ(device->preset().name, preset);
    EXPECT_EQ(device->preset().capability.stylus_weight_n, 0.0) << "the vendor carries it";
    device.reset();
  }
  vendor->set_type(dhd::kOmega3, "omega.3", false);
  const Status unknown = open();
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text().find("omega.3"), std::string::npos);
}

TEST_F(ForceDimension, SendsTorqueOnlyToActiveWrists) {
  open_or_fail();  // an omega.6: the stand-in notes a torque for it
  EXPECT_TRUE(device->write({Vec3(0, 0, 1), Vec3(10, 20, 30)}));
  pace->step(1);
  device.reset();

  vendor->set_type(dhd::kSigma7, "sigma.7", true);
  open_or_fail();
  EXPECT_TRUE(device->write({Vec3(0, 0, 1), Vec3(10, 20, 30)}));
  pace->step(1);
  EXPECT_LT((vendor->arm().torque_nmm - Vec3(-20, 10, 30)).norm(), kTiny);
}

TEST_F(ForceDimension, KeepsTheVendorSafetyOn) {
  vendor->set_watchdog(0);
  open_or_fail();
  EXPECT_EQ(vendor->watchdog(), 160) << "20 ms in counts of 125 us";
  EXPECT_TRUE(vendor->has_gravity_compensation());
  device.reset();
  vendor->set_watchdog(40);
  open_or_fail();
  EXPECT_EQ(vendor->watchdog(), 40) << "as it was set";
}

TEST_F(ForceDimension, RefusesWritesWhenTheDeviceCutsItsMotors) {
  open_or_fail();
  for (const int cause : {dhd::kForceOffButton, dhd::kForceOffVelocity, dhd::kForceOffWatchdog}) {
    vendor->force_off(cause);
    device->write({Vec3(0, 0, 1), Vec3::Zero()});
    EXPECT_EQ(read_after(kPeriodsToNotice).status, DeviceStatus::kFresh);
    EXPECT_FALSE(device->write({Vec3(0, 0, 1), Vec3::Zero()}));
    EXPECT_FALSE(vendor->has_force()) << "not switched on again by us";
    vendor->force_off(0);
    read_after(kPeriodsToNotice);
    EXPECT_TRUE(device->write({Vec3(0, 0, 1), Vec3::Zero()}));
  }
}

TEST_F(ForceDimension, ReadThatCameTooEarlyIsRepeated) {
  open_or_fail();
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  vendor->answer_time_guard(true);
  EXPECT_EQ(read_after(1).status, DeviceStatus::kRepeated);
}

TEST_F(ForceDimension, ForceAboveThePeakIsCut) {
  open_or_fail();
  const double peak_n = device->preset().capability.peak_force_n;
  EXPECT_NEAR(force_after({0, 0, 5 * peak_n}).norm(), peak_n, kTiny);
  EXPECT_FALSE(device->write({Vec3(0, 0, 1e6), Vec3::Zero()})) << "no gate writes that";
  pace->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
}

TEST_F(ForceDimension, ZeroesAStaleWrench) {
  open_or_fail();
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
  pace->advance(0.9 * ServoExchange::kOldestWrench_s);
  pace->step(1);
  EXPECT_GT(vendor->arm().force_n.norm(), 0.9);
  pace->advance(0.2 * ServoExchange::kOldestWrench_s);
  pace->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
}

TEST_F(ForceDimension, RefusesANanWrenchAndZeroesTheForce) {
  open_or_fail();
  force_after({0, 0, 1});
  EXPECT_FALSE(device->write({Vec3::Zero(), Vec3(std::nan(""), 0, 0)})) << "even of a torque that it drops";
  pace->step(1);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
}

TEST_F(ForceDimension, PassesANanPoseAndZeroesTheForce) {
  open_or_fail();
  force_after({0, 0, 1});
  vendor->send_nan(true);
  device->write({Vec3(0, 0, 1), Vec3::Zero()});
  EXPECT_FALSE(read_after(1).X_DS.is_finite());
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
}

TEST_F(ForceDimension, StaysDisconnectedUntilReconnected) {
  open_or_fail();
  force_after({0, 0, 1});
  vendor->set_present(false);
  EXPECT_EQ(read_after(10).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(device->write({Vec3(0, 0, 1), Vec3::Zero()}));
  const Status gone = device->reconnect();
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().text().find("no device found"), std::string::npos) << gone.error().text();
  EXPECT_EQ(device->read(now_s).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(device->write(Wrench{}));

  vendor->set_present(true);
  const Status back = device->reconnect();
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_GT(force_after({0, 0, 1}).norm(), 0.9);
}

TEST_F(ForceDimension, ToleratesAShortReadFailure) {
  open_or_fail();
  read_after(1);
  vendor->set_present(false);
  EXPECT_EQ(read_after(2).status, DeviceStatus::kRepeated);
  vendor->set_present(true);
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
}

TEST_F(ForceDimension, ZeroesTheForceWhenClosed) {
  open_or_fail();
  EXPECT_GT(force_after({0, 0, 2}).norm(), 1.9);
  device.reset();
  EXPECT_EQ(vendor->arm().force_n.norm(), 0.0);
  EXPECT_FALSE(vendor->has_force());
}

TEST_F(ForceDimension, ReportsAMissingLibrary) {
  setenv("TROCAR_LIBDHD", "/nowhere/libdhd.so", 1);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().exit_status, 1);
  for (const char* word : {"Force Dimension", "/nowhere/libdhd.so", "TROCAR_LIBDHD", "udev"}) {
    EXPECT_NE(status.error().text().find(word), std::string::npos) << status.error().text();
  }
}

TEST_F(ForceDimension, ReportsAMissingDevice) {
  vendor->set_present(false);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("no Force Dimension device"), std::string::npos);
  EXPECT_NE(status.error().text().find("connect"), std::string::npos);
}

TEST_F(ForceDimension, ReportsAnUncalibratedDevice) {
  vendor->set_calibrated(false);
  const Status status = open();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("calibration pit"), std::string::npos) << status.error().text();
}

TEST_F(ForceDimension, OpensByKindAndRunsAtItsOwnRate) {
  DeviceOptions options;
  options.devices_file = testing::source_dir() / "data/devices.toml";
  options.preset = "no such row";
  const auto opened = open_device({"forcedimension", ""}, options);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().exit_status, 2);
}

TEST_F(ForceDimension, ReadAndWriteDoNotAllocate) {
  open_or_fail();
  pace->step(1);
  testing::AllocationGuard guard;
  device->read(now_s);
  device->write({Vec3(0, 0, 1), Vec3(1, 0, 0)});
  device->write({Vec3(0, 0, std::nan("")), Vec3::Zero()});
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(ForceDimension, RunsIndependentlyOfTheRealTimeThread) {
  open_or_fail();
  pace->run_freely();
  int fresh = 0;
  while (fresh < 1000) {
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
TEST_F(ForceDimension, StandInRecordsRuleViolations) {
  const auto api = dhd::load_api();
  ASSERT_TRUE(api);
  const auto broken = [&] {
    const std::string text = vendor->violations();
    vendor->reset();
    return text;
  };
  api->set_wrench(0, 0, 1, 0, 0, 0, 0, 0);
  EXPECT_NE(broken().find("without a device"), std::string::npos);
  api->open();
  api->set_wrench(0, 0, 1, 0, 0, 0, 0, 0);
  EXPECT_NE(broken().find("before dhdEnableForce"), std::string::npos);
  api->open();
  api->set_watchdog(0, 0);
  EXPECT_NE(broken().find("watchdog was switched off"), std::string::npos);
  api->open();
  api->enable_force(dhd::kOn, 0);
  api->close(0);
  EXPECT_NE(broken().find("motors on"), std::string::npos);
}

TEST_F(ForceDimension, FailsToOpenAndReconnectWithoutAThread) {
  {
    const trocar::testing::NoThreads none;
    const Status refused = open();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().what.find("does not start"), std::string::npos) << refused.error().text();
    EXPECT_FALSE(vendor->is_open());
  }
  open_or_fail();
  {
    const trocar::testing::NoThreads none;
    EXPECT_FALSE(device->reconnect());
    EXPECT_EQ(device->read(now_s).status, DeviceStatus::kDisconnected);
    EXPECT_FALSE(device->write({Vec3(1, 0, 0), Vec3::Zero()}));
    EXPECT_FALSE(vendor->is_open());
  }
  ASSERT_TRUE(device->reconnect());
  EXPECT_EQ(read_after(1).status, DeviceStatus::kFresh);
}

}  // namespace
}  // namespace trocar::devices
