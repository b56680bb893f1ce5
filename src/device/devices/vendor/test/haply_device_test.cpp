#include "devices/vendor/haply_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/no_threads.h"
#include "devices/device_spec.h"
#include "devices/test/bad_numbers.h"
#include "devices/test/bounded_wait.h"
#include "devices/testing/haply_service.h"
#include "devices/vendor/detail/haply_messages.h"
#include "devices/vendor/detail/websocket.h"
#include "devices/workspace_map.h"

namespace trocar::devices {
namespace {

using testing::HaplyMood;
using testing::HaplyService;
using testing::kInfinity;
using testing::kNaN;
using testing::wait_until;

constexpr double kRightAngle_rad = 1.5707963267948966;
constexpr double kTolerance_mm = 1e-6;  // decimal text there and back

stylus::DevicePreset inverse3() {
  stylus::DevicePreset preset;
  preset.name = "inverse3";
  preset.actuated_dof = 3;
  preset.capability.peak_force_n = 8.0;
  return preset;
}

std::unique_ptr<HapticDevice> open_at(const HaplyService& service) {
  auto device = HaplyDevice::open(inverse3(), service.address());
  EXPECT_TRUE(device.has_value()) << device.error().text();
  return device ? std::move(*device) : nullptr;
}

std::string error_of(HaplyMood mood) {
  const HaplyService service(mood);
  const auto device = HaplyDevice::open(inverse3(), service.address());
  return device ? "opened" : device.error().text();
}

Wrench pull(double x, double y, double z) {
  return {Vec3(x, y, z), Vec3::Zero()};
}

/// Reads until the status comes.
bool comes_to(HapticDevice& device, DeviceStatus status) {
  return wait_until([&] { return device.read(0.0).status == status; });
}

TEST(HaplyMessage, ConvertsToTheDeviceFrameInMm) {
  HaplyState state;
  state.p_m = kHaplyCentre_m + Vec3(0.01, 0.02, -0.03);
  const Pose X_DS = haply_pose(state, false);
  EXPECT_NEAR((X_DS.p() - Vec3(10.0, 20.0, -30.0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(X_DS.R(), Mat3::Identity().eval());
  state.p_m = Vec3(0.01, 0.02, -0.03);
  EXPECT_NEAR((haply_pose(state, true).p() - Vec3(10.0, 20.0, -30.0)).norm(), 0.0, 1e-9);
}

TEST(HaplyMessage, MapsTheGripAxisToTheNeedleAxis) {
  HaplyState state;
  // The grip at rest points forward, away from the user: +y of D.
  state.q_grip = Eigen::Quaterniond::Identity();
  Mat3 R_DS = haply_pose(state, true).R();
  EXPECT_NEAR((R_DS.col(2) - Vec3::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((R_DS.col(0) - Vec3::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(R_DS.determinant(), 1.0, 1e-12);
  // Nodding by a right angle about +x lifts forward to up.
  state.q_grip = Eigen::Quaterniond(Eigen::AngleAxisd(kRightAngle_rad, Vec3::UnitX()));
  R_DS = haply_pose(state, true).R();
  EXPECT_NEAR((R_DS.col(2) - Vec3::UnitZ()).norm(), 0.0, 1e-12);
}

TEST(HaplyMessage, TreatsHostileBytesAsMalformed) {
  const char* const kHostile[] = {
      "",
      "nul",
      "[]",
      "7",
      R"({"inverse3":{}})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":"1","y":0,"z":0}}}]})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":1e300,"y":0,"z":0}}}]})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":NaN,"y":0,"z":0}}}]})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":[0,0,0]}}]})",
      R"({"inverse3":[{"device_id":"1","state":7}]})",
      R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":0,"y":0,"z":0}}}],"wireless_verse_grip":[7]})",
      "{\"inverse3\":[{\"device_id\":\"\xff\"}]}",
  };
  for (const char* text : kHostile) {
    EXPECT_EQ(parse_haply_state(text, {}).condition, HaplyCondition::kMalformed) << text;
  }
  EXPECT_EQ(parse_haply_state(std::string(100'000, '['), {}).condition, HaplyCondition::kMalformed);
  EXPECT_EQ(parse_haply_state(std::string(kMostHaplyBytes + 1, ' '), {}).condition, HaplyCondition::kMalformed);
}

TEST(HaplyMessage, TreatsANonRotationGripAsMalformed) {
  const std::string state = R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":0,"y":0,"z":0}}}],)";
  const auto with_grip = [&](const char* q) {
    return parse_haply_state(state + R"("wireless_verse_grip":[{"state":{"orientation":)" + q + "}}]}", {}).condition;
  };
  EXPECT_EQ(with_grip(R"({"w":1,"x":0,"y":0,"z":0})"), HaplyCondition::kReady);
  EXPECT_EQ(with_grip(R"({"w":0,"x":0,"y":0,"z":0})"), HaplyCondition::kMalformed);
  EXPECT_EQ(with_grip(R"({"w":1e200,"x":1e200,"y":0,"z":0})"), HaplyCondition::kMalformed);
}

TEST(HaplyMessage, SelectsTheRequestedDevice) {
  const std::string text = R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0.1,"y":0,"z":0}}},)"
                           R"({"device_id":"B","state":{"cursor_position":{"x":0.2,"y":0,"z":0}}}]})";
  EXPECT_EQ(parse_haply_state(text, {}).device_id, "A");
  EXPECT_EQ(parse_haply_state(text, "B").p_m.x(), 0.2);
  EXPECT_EQ(parse_haply_state(text, "C").condition, HaplyCondition::kNoDevice);
}

TEST(HaplyMessage, EscapesTheDeviceIdInCommands) {
  const std::string command = haply_force_command("a\",\"b\":\"", Vec3::Zero());
  EXPECT_NE(command.find(R"("a\",\"b\":\"")"), std::string::npos) << command;
}

TEST(WebSocketAddress, ParsesOrRefusesAddresses) {
  const auto address = parse_websocket_address("ws://localhost:10001");
  ASSERT_TRUE(address.has_value());
  EXPECT_EQ(address->host, "localhost");
  EXPECT_EQ(address->port, "10001");
  EXPECT_EQ(address->path, "/");
  for (const char* bad : {"", "localhost:10001", "http://localhost", "ws://", "ws://a:b", "ws://a:123456", "ws://a b",
                          "ws://a/x y", "wss://a:1"}) {
    const auto refused = parse_websocket_address(bad);
    ASSERT_FALSE(refused.has_value()) << bad;
    EXPECT_EQ(refused.error().exit_status, 2);
  }
}

TEST(HaplyDevice, ReportsThePoseAndButtonsOfTheService) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  service.put_cursor(kHaplyCentre_m + Vec3(0.011, -0.022, 0.033));
  service.set_grip(Eigen::Quaterniond(Eigen::AngleAxisd(kRightAngle_rad, Vec3::UnitX())), true, true);
  DeviceReading reading;
  EXPECT_TRUE(wait_until([&] {
    reading = device->read(0.0);
    return reading.buttons == (kButtonMain | kButtonSecond);
  }));
  EXPECT_NEAR((reading.X_DS.p() - Vec3(11.0, -22.0, 33.0)).norm(), 0.0, kTolerance_mm);
  EXPECT_NEAR((reading.X_DS.R().col(2) - Vec3::UnitZ()).norm(), 0.0, 1e-9);
  EXPECT_EQ(device->preset().sensed_dof, 6);
  EXPECT_FALSE(device->preset().has_torque());
}

TEST(HaplyDevice, UsesTheCentreReportedByTheService) {
  HaplyService service;
  service.set_centred(true);
  service.put_cursor(Vec3(0.01, 0.0, 0.0));
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_NEAR((device->read(0.0).X_DS.p() - Vec3(10.0, 0.0, 0.0)).norm(), 0.0, kTolerance_mm);
}

TEST(HaplyDevice, WithoutAGripSensesThreeDegreesOfFreedom) {
  const HaplyService service(HaplyMood::kNoGrip);
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->preset().sensed_dof, 3);
  EXPECT_EQ(device->read(0.0).X_DS.R(), Mat3::Identity().eval());
}

TEST(HaplyDevice, SelectsTheDeviceById) {
  const HaplyService service;
  EXPECT_TRUE(HaplyDevice::open(inverse3(), service.address() + "#049D").has_value());
  const auto other = HaplyDevice::open(inverse3(), service.address() + "#1234");
  ASSERT_FALSE(other.has_value());
  EXPECT_NE(other.error().text().find("no Inverse3"), std::string::npos);
}

TEST(HaplyDevice, ReconnectsOnlyWithItsGrip) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  service.set_mood(HaplyMood::kNoGrip);
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kDisconnected));
  const Status status = device->reconnect();
  ASSERT_FALSE(status.has_value());
  EXPECT_NE(status.error().text().find("the grip is missing"), std::string::npos);
  EXPECT_EQ(device->read(0.0).status, DeviceStatus::kDisconnected);
}

TEST(HaplyDevice, IgnoresAGripThatAppearsLater) {
  HaplyService service(HaplyMood::kNoGrip);
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  service.set_grip(Eigen::Quaterniond(Eigen::AngleAxisd(kRightAngle_rad, Vec3::UnitX())), true, false);
  service.set_mood(HaplyMood::kGood);
  DeviceReading reading;
  EXPECT_TRUE(wait_until([&] {
    reading = device->read(0.0);
    return reading.buttons == kButtonMain;
  }));
  EXPECT_EQ(reading.X_DS.R(), Mat3::Identity().eval());
}

TEST(HaplyDevice, ForceMovesTheCursorAlongIt) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  const Vec3 f_D(0.3, -0.2, 0.1);
  const Vec3 from_mm = device->read(0.0).X_DS.p();
  Vec3 moved_mm = Vec3::Zero();
  constexpr double kFar_mm = 1.0;
  EXPECT_TRUE(wait_until([&] {
    EXPECT_TRUE(device->write({f_D, Vec3::Zero()}));
    moved_mm = device->read(0.0).X_DS.p() - from_mm;
    return moved_mm.norm() > kFar_mm;
  }));
  EXPECT_LT(angle_between_rad(moved_mm, f_D), 1e-3);
}

TEST(HaplyDevice, AnswersEachOfAThousandStatesOnce) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  constexpr std::uint64_t kMessages = 1000;
  EXPECT_TRUE(wait_until([&] {
    device->write(pull(0.01, 0.0, 0.0));
    return service.commands() >= kMessages;
  }));
  EXPECT_EQ(service.violations(), std::vector<std::string>{});
}

TEST(HaplyDevice, ZeroesTheForceWhenWritesStop) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_TRUE(wait_until([&] {
    device->write(pull(0.0, 0.0, 0.5));
    return service.last_force_n().z() == 0.5;
  }));
  EXPECT_TRUE(wait_until([&] { return service.last_force_n().isZero(0.0); }));
  EXPECT_NE(device->read(0.0).status, DeviceStatus::kDisconnected);
}

TEST(HaplyDevice, RefusesNonFiniteForcesAndZeroesTheForce) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  for (const double bad : {kNaN, kInfinity}) {
    EXPECT_TRUE(wait_until([&] {
      device->write(pull(0.0, 0.5, 0.0));
      return service.last_force_n().y() == 0.5;
    }));
    EXPECT_FALSE(device->write(pull(0.0, bad, 0.0)));
    EXPECT_TRUE(wait_until([&] { return service.last_force_n().isZero(0.0); }));
  }
  EXPECT_EQ(service.violations(), std::vector<std::string>{});
}

TEST(HaplyDevice, ClosesAtZeroForce) {
  HaplyService service;
  auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_TRUE(wait_until([&] {
    device->write(pull(0.5, 0.0, 0.0));
    return service.last_force_n().x() == 0.5;
  }));
  device->write(pull(0.5, 0.0, 0.0));
  device.reset();
  EXPECT_TRUE(service.last_force_n().isZero(0.0));
  EXPECT_TRUE(wait_until([&] { return !service.is_connected(); }));
  EXPECT_EQ(service.violations(), std::vector<std::string>{});
}

TEST(HaplyDevice, ReportsWhatIsMissingWhenOpened) {
  EXPECT_NE(error_of(HaplyMood::kNoDevice).find("no Inverse3 is connected"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kNoPower).find("power supply"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kNotCalibrated).find("not calibrated"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kNotReady).find("not ready"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kNotJson).find("cannot be read"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kWrongTypes).find("cannot be read"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kTooLong).find("sends no data"), std::string::npos);
  EXPECT_NE(error_of(HaplyMood::kClose).find("sends no data"), std::string::npos);
}

TEST(HaplyDevice, ErrorExplainsHowToStartTheService) {
  std::string address;
  {
    const HaplyService service;
    address = service.address();  // nobody listens there once it is gone
  }
  const auto device = HaplyDevice::open(inverse3(), address);
  ASSERT_FALSE(device.has_value());
  EXPECT_NE(device.error().text().find("start the Inverse service"), std::string::npos);
}

class HaplyTrouble : public ::testing::TestWithParam<HaplyMood> {};

TEST_P(HaplyTrouble, DisconnectsWithoutForceThenReconnects) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_TRUE(wait_until([&] {
    device->write(pull(0.0, 0.2, 0.0));
    return service.last_force_n().y() == 0.2;
  }));
  service.set_mood(GetParam());
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kDisconnected));
  EXPECT_FALSE(device->write(pull(0.0, 0.2, 0.0)));
  EXPECT_TRUE(device->read(0.0).X_DS.is_finite());
  const bool has_hung_up = GetParam() == HaplyMood::kClose || GetParam() == HaplyMood::kTooLong;
  if (!has_hung_up) {
    EXPECT_TRUE(wait_until([&] { return service.last_force_n().isZero(0.0); }));
  }
  service.set_mood(HaplyMood::kGood);
  const Status status = device->reconnect();
  ASSERT_TRUE(status.has_value()) << status.error().text();
  EXPECT_EQ(service.connections(), 2);
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kFresh));
  EXPECT_TRUE(wait_until([&] { return service.last_force_n().isZero(0.0); }));
}

INSTANTIATE_TEST_SUITE_P(Moods, HaplyTrouble,
                         ::testing::Values(HaplyMood::kClose, HaplyMood::kNotJson, HaplyMood::kWrongTypes,
                                           HaplyMood::kHugeNumbers, HaplyMood::kTooLong, HaplyMood::kStalled,
                                           HaplyMood::kNotCalibrated, HaplyMood::kNoPower, HaplyMood::kNotReady,
                                           HaplyMood::kNoDevice, HaplyMood::kNoGrip));

TEST(HaplyDevice, AShortDisturbanceRepeatsThePoseWithoutForce) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  EXPECT_TRUE(wait_until([&] {
    device->write(pull(0.0, 0.2, 0.0));
    return service.last_force_n().y() == 0.2;
  }));
  service.set_mood(HaplyMood::kStalled);
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kRepeated));
  service.set_mood(HaplyMood::kGood);
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kFresh));
}

TEST(HaplyDevice, ReconnectWithoutAServiceFailsAndCanBeRetried) {
  auto service = std::make_unique<HaplyService>();
  const auto device = open_at(*service);
  ASSERT_NE(device, nullptr);
  service.reset();
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kDisconnected));
  EXPECT_FALSE(device->reconnect().has_value());
  EXPECT_EQ(device->read(0.0).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(device->reconnect().has_value());
}

TEST(HaplyDevice, ReadAndWriteDoNotAllocate) {
  HaplyService service;
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  constexpr int kTicks = 1000;
  const testing::AllocationGuard guard;
  for (int i = 0; i < kTicks; ++i) {
    device->read(0.001 * i);
    device->write(pull(0.01, 0.0, 0.0));
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(HaplyDevice, IsOpenedByItsName) {
  const HaplyService service;
  const auto spec = parse_device_spec("haply:" + service.address());
  ASSERT_TRUE(spec.has_value()) << spec.error().text();
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  const auto device = open_device(*spec, options);
  ASSERT_TRUE(device.has_value()) << device.error().text();
  EXPECT_EQ((*device)->preset().name, "inverse3");
}

TEST(HaplyDevice, AppliesASavedWeight) {
  const HaplyService service;
  const TemporaryFolder folder;
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  options.stylus_folder = folder.path();
  ASSERT_TRUE(save_stylus_profile({"haply:" + service.address(), "inverse3", 0.7, std::nullopt}, folder.path()));
  const auto device = open_device({"haply", service.address()}, options);
  ASSERT_TRUE(device.has_value()) << device.error().text();
  EXPECT_EQ((*device)->preset().capability.stylus_weight_n, 0.7);
}

TEST(HaplyDevice, FailsToOpenAndReconnectWithoutAThread) {
  const HaplyService service(HaplyMood::kGood);
  {
    const trocar::testing::NoThreads none;
    const auto refused = HaplyDevice::open(inverse3(), service.address());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().what.find("does not start"), std::string::npos) << refused.error().text();
  }
  const auto device = open_at(service);
  ASSERT_NE(device, nullptr);
  {
    const trocar::testing::NoThreads none;
    EXPECT_FALSE(device->reconnect());
    EXPECT_EQ(device->read(0.0).status, DeviceStatus::kDisconnected);
    EXPECT_FALSE(device->write(pull(1.0, 0.0, 0.0)));
  }
  ASSERT_TRUE(device->reconnect());
  EXPECT_TRUE(comes_to(*device, DeviceStatus::kFresh));
}

}  // namespace
}  // namespace trocar::devices
