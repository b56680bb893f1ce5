// A trainee's attempt with a gamepad or a SpaceMouse, each a stand-in that the real haptic server opens.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "attempt/live/live_attempt.h"
#include "core/files/folders.h"
#include "devices/testing/gamepad_stand_in.h"
#include "devices/testing/spacenav_daemon.h"
#include "servers/live_attempt_lab.h"

namespace trocar::servers_test {
namespace {

using testing::GamepadStandIn;
using testing::SpacenavDaemon;

class DeviceAttemptTest : public ::testing::Test {
 protected:
  void start(const char* device) {
    attempt::AttemptOptions options;
    options.session = folder_ / "attempt.trocar";
    options.priority = 0;  // ordinary scheduling: it takes no core from other tests
    options.timeout = std::chrono::seconds(30);
    options.device_needle = device;
    options.has_probe = false;
    attempt = std::make_unique<attempt::LiveAttempt>(layered_case(), options);
  }
  bool wait_phase(attempt::AttemptPhase phase) {
    return wait_for([&] {
             const attempt::AttemptPhase now = attempt->view().phase;
             return now == phase || now == attempt::AttemptPhase::kFailed;
           }) &&
           attempt->view().phase == phase;
  }
  bool wait_deeper(double depth_mm) {
    return wait_for([&] { return attempt->view().needle.depth_mm > depth_mm; });
  }
  /// Nothing moves it any more.
  bool wait_rest() {
    return wait_for([&] { return std::abs(attempt->view().needle.speed_mm_s) < 0.1; });
  }
  Error failure() {
    EXPECT_TRUE(wait_for([&] { return attempt->view().phase == attempt::AttemptPhase::kFailed; }));
    auto result = attempt->take_result();
    return result && !*result ? result->error() : Error{};
  }
  std::string where() const {
    const attempt::AttemptView view = attempt->view();
    return std::string(to_string(view.phase)) + " | " + view.progress + " | " + view.banner;
  }

  TemporaryFolder folder_;
  std::unique_ptr<attempt::LiveAttempt> attempt;
};

TEST_F(DeviceAttemptTest, AGamepadPushesTheNeedleInAndRumbles) {
  GamepadStandIn pad;
  start("gamepad");
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  EXPECT_EQ(attempt->view().servers[0].device, "gamepad");
  const Pose begun = attempt->view().needle.X_PN;
  EXPECT_NEAR((begun.p() - layered_case()->the_case.plan.line_P.a).norm(), 20.0, 1.0);
  // A hand of the window moves nothing.
  attempt->set_goal(attempt::Tool::kNeedle, begun * Pose::translation({0.0, 0.0, 30.0}));
  pad.push_left_stick(1.0, 0.0);
  ASSERT_TRUE(wait_for([&] { return (attempt->view().needle.X_PN.p() - begun.p()).norm() > 3.0; })) << where();
  pad.push_left_stick(0.0, 0.0);
  EXPECT_EQ(attempt->view().phase, attempt::AttemptPhase::kReady);
  pad.pull_right_trigger(0.8);
  ASSERT_TRUE(wait_deeper(12.0)) << where();
  pad.pull_right_trigger(0.0);
  ASSERT_TRUE(wait_rest()) << where();
  EXPECT_GT(pad.strongest_rumble(), 0);
  EXPECT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
}

TEST_F(DeviceAttemptTest, ContinuesWhenAnUnpluggedGamepadReturns) {
  GamepadStandIn pad;
  start("gamepad");
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  pad.pull_right_trigger(0.8);
  ASSERT_TRUE(wait_deeper(12.0)) << where();
  pad.pull_right_trigger(0.0);
  ASSERT_TRUE(wait_rest()) << where();
  const double depth_mm = attempt->view().needle.depth_mm;
  pad.plug(false);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kServerLost)) << where();
  ASSERT_TRUE(wait_for([&] { return attempt->view().banner.find("gamepad is disconnected") != std::string::npos; }))
      << where();
  const int pid = attempt->view().servers[0].pid;
  pad.plug(true);
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
  EXPECT_TRUE(attempt->view().banner.empty()) << attempt->view().banner;
  EXPECT_EQ(attempt->view().servers[0].pid, pid);  // its server is the same
  ASSERT_TRUE(wait_rest()) << where();
  constexpr double kSettles_mm = 2.0;  // it was laid down anew, without what the tissue held
  EXPECT_NEAR(attempt->view().needle.depth_mm, depth_mm, kSettles_mm);
  pad.pull_right_trigger(0.8);
  EXPECT_TRUE(wait_deeper(depth_mm + 5.0)) << where();
}

TEST_F(DeviceAttemptTest, ReportsAMissingGamepadInOneLine) {
  const GamepadStandIn unplugged(false);
  start("gamepad");
  const Error error = failure();
  EXPECT_EQ(error.what, "no gamepad is connected");
  EXPECT_NE(error.advice.find("connect or pair one"), std::string::npos) << error.advice;
}

TEST_F(DeviceAttemptTest, SpaceMousePushesTheNeedleInAndMayBeUnplugged) {
  SpacenavDaemon daemon;
  start("spacemouse");
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kReady)) << where();
  // The cap repeats itself, as spacenavd does: what is silent counts as let go. The axis of the device along which the
  // needle goes in, in its own order: x right, y up, z away.
  const auto push_until = [&](int counts, const std::function<bool()>& is_so) {
    return wait_for([&] {
      daemon.push_cap({0, counts, 0, 0, 0, 0});
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      return is_so();
    });
  };
  const auto is_deeper = [&](double mm) { return [this, mm] { return attempt->view().needle.depth_mm > mm; }; };
  ASSERT_TRUE(push_until(-200, is_deeper(12.0))) << where();
  EXPECT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
  ASSERT_TRUE(wait_rest()) << where();
  daemon.unplug_device();
  ASSERT_TRUE(wait_for([&] { return attempt->view().banner.find("SpaceMouse is disconnected") != std::string::npos; }))
      << where();
  // The daemon still answers, so the device is taken for back.
  ASSERT_TRUE(wait_phase(attempt::AttemptPhase::kInBody)) << where();
  EXPECT_TRUE(push_until(-200, is_deeper(18.0))) << where();
}

TEST_F(DeviceAttemptTest, ReportsAMissingSpaceMouseInOneLine) {
  ::setenv("SPNAV_SOCKET", (folder_ / "nobody").c_str(), 1);
  start("spacemouse");
  EXPECT_EQ(failure().what, "spacenavd does not respond");
  ::unsetenv("SPNAV_SOCKET");
}

}  // namespace
}  // namespace trocar::servers_test
