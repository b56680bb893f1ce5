// Processes that die, stop and come back, on either side of the link.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>

#include <thread>

#include "servers/live_server.h"

namespace trocar::servers_test {
namespace {

constexpr const char* kHeldUrl = "TROCAR_TEST_HELD_URL";

/// A client in a process of its own: this program again, with the test below.
link::ServerProcess start_holder(const std::string& url) {
  ::setenv(kHeldUrl, url.c_str(), 1);
  auto holder = link::ServerProcess::start(
      "/proc/self/exe", {"--gtest_also_run_disabled_tests", "--gtest_filter=*HoldsTheServerUntilItIsKilled"});
  ::unsetenv(kHeldUrl);
  EXPECT_TRUE(holder) << holder.error().text();
  return std::move(*holder);
}

/// What a watching client sees of the force after something happened: when it began to fade and when it was gone.
struct Fade {
  bool has_begun = false, has_ended = false;
  double began_s = 0.0, ended_s = 0.0;
};
void follow(Fade& fade, const std::vector<link::NumberedSample>& samples) {
  for (const link::NumberedSample& numbered : samples) {
    const telemetry::TickSample& sample = numbered.sample;
    if (!fade.has_begun && has_limit(sample, telemetry::LimitReason::kStale)) {
      fade.has_begun = true;
      fade.began_s = sample.time_s;
    }
    if (fade.has_begun && !fade.has_ended && sample.device_f_n.norm() == 0.0) {
      fade.has_ended = true;
      fade.ended_s = sample.time_s;
    }
  }
}

Fade watch_fade(link::HapticClient& watcher) {
  Fade fade;
  wait_for([&] {
    follow(fade, watcher.take_samples());
    return fade.has_ended;
  });
  return fade;
}

/// The holder presses on the skin; what the watcher has seen so far is taken.
::testing::AssertionResult wait_until_felt(link::HapticClient& watcher) {
  const bool is_felt = wait_for([&] {
    const auto newest = watcher.newest();
    return newest && felt_n(*newest) > 0.5;
  });
  watcher.take_samples();
  if (is_felt) return ::testing::AssertionSuccess();
  const link::ServerStatus status = watcher.view().status;
  return ::testing::AssertionFailure() << "not felt: " << to_string(status.state) << ", forces "
                                       << to_string(status.gate_mode) << ", fault " << to_string(status.fault);
}

// Not a test: the other process of the tests below.
TEST(Holder, DISABLED_HoldsTheServerUntilItIsKilled) {
  const char* url = ::getenv(kHeldUrl);
  ASSERT_NE(url, nullptr);
  link::HapticClient client = connect(url);
  // Another process has to feel it, however late it looks: the hand goes on pressing.
  double depth_mm = 0.0;
  press_on_skin(client, &depth_mm);
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) keep_pressing(client, 0.7, depth_mm);
}

TEST(Liveness, ForceFadesInTimeWhenTheClientIsKilled) {
  LiveServer server;
  link::ServerProcess holder = start_holder(server.url());
  link::HapticClient watcher = connect(server.url(), false);
  ASSERT_TRUE(wait_until_felt(watcher));
  ::kill(holder.pid(), SIGKILL);
  const Fade fade = watch_fade(watcher);
  ASSERT_TRUE(fade.has_ended);
  // By the server's own clock: 200 ms, and a hole of the machine's scheduling.
  EXPECT_LE(fade.ended_s - fade.began_s, 0.2 + 0.05);
}

TEST(Liveness, ForceFadesWhileTheClientIsSuspended) {
  LiveServer server;
  link::ServerProcess holder = start_holder(server.url());
  link::HapticClient watcher = connect(server.url(), false);
  ASSERT_TRUE(wait_until_felt(watcher));
  ::kill(holder.pid(), SIGSTOP);
  const Fade fade = watch_fade(watcher);
  ASSERT_TRUE(fade.has_ended);
  ::kill(holder.pid(), SIGCONT);
  std::optional<link::NumberedSample> last;
  double largest_rise_n = 0.0;
  ASSERT_TRUE(wait_for([&] {
    for (const link::NumberedSample& numbered : watcher.take_samples()) {
      // Of neighbours alone: where the machine skipped periods the force goes on from where it would be.
      if (last && numbered.sample.time_s - last->sample.time_s < 0.0015) {
        const double rise_n = numbered.sample.device_f_n.norm() - last->sample.device_f_n.norm();
        largest_rise_n = std::max(largest_rise_n, rise_n);
      }
      last = numbered;
    }
    return last && felt_n(last->sample) > 0.4;
  })) << to_string(watcher.view().status.state);
  EXPECT_LT(largest_rise_n, 0.1) << "N in one tick";
}

TEST(Liveness, ClientDetectsAKilledServerAndItsSuccessor) {
  LiveServer server;
  link::HapticClient client = connect(server.url());
  press_on_skin(client);
  const std::uint64_t first_session = client.view().welcome.session;
  server.kill(SIGKILL);
  EXPECT_TRUE(wait_for([&] { return !client.view().is_connected; }));
  EXPECT_TRUE(wait_for([&] { return !server.process().is_running(); }));
  EXPECT_FALSE(client.ask(link::ServerCommand::kStart, std::chrono::milliseconds(100))) << "nobody is there";
  server.start();
  ASSERT_TRUE(wait_for([&] { return client.view().is_connected && client.view().welcome.session != first_session; }));
  press_on_skin(client);
}

TEST(Liveness, SuspendedServerHasAFaultUntilReset) {
  LiveServer server;
  link::HapticClient client = connect(server.url());
  press_on_skin(client);
  server.kill(SIGSTOP);
  constexpr double kStopped_s = 0.5;  // twice the hole that a loop may have
  EXPECT_TRUE(wait_for([&] { return client.view().silent_s > kStopped_s; }));
  server.kill(SIGCONT);
  ASSERT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kFault; }));
  const telemetry::GateFault fault = client.view().status.fault;
  EXPECT_TRUE(fault == telemetry::GateFault::kLoopStalled || fault == telemetry::GateFault::kLoopSlow)
      << to_string(fault);  // slow: it came late on a busy machine before
  EXPECT_TRUE(wait_for([&] {
    const auto newest = client.newest();
    return newest && newest->device_f_n.norm() == 0.0;
  }));
  EXPECT_TRUE(wait_for([&] {
    return client.ask(link::ServerCommand::kResetFault, kPatience) &&
           client.view().status.fault == telemetry::GateFault::kNone;
  }));
}

TEST(Liveness, WritesAFlightRecordOfAFault) {
  LiveServer server({"--fault", "nan@0.1"});
  link::HapticClient client = connect(server.url());
  ASSERT_TRUE(client.ask(layers_scene(), kPatience));
  EXPECT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kFault; }));
  EXPECT_TRUE(wait_for([&] { return client.view().status.warning.find("flight-") != std::string::npos; }))
      << client.view().status.warning;
  int flights = 0;
  for (const auto& entry : std::filesystem::directory_iterator(server.folder().path())) {
    if (entry.path().filename().string().starts_with("flight-")) ++flights;
  }
  EXPECT_EQ(flights, 1);
}

TEST(Liveness, AnUnpluggedDeviceIsOpenedAgainOnRequest) {
  LiveServer server({"--fault", "disconnect@0.1+0.2"});
  link::HapticClient client = connect(server.url());
  ASSERT_TRUE(client.ask(layers_scene(), kPatience));
  ASSERT_TRUE(wait_for([&] { return client.view().status.fault == telemetry::GateFault::kDeviceLost; }));
  // The schedule plugs it in again after a while; until then it stays lost.
  ASSERT_TRUE(wait_for([&] {
    return client.ask(link::ServerCommand::kReconnect, kPatience) &&
           client.ask(link::ServerCommand::kResetFault, kPatience) &&
           client.view().status.fault == telemetry::GateFault::kNone;
  }));
  ASSERT_TRUE(client.ask(link::ServerCommand::kStart, kPatience));
  EXPECT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kRunning; }));
}

TEST(Liveness, EndsOnSigtermWithExitStatusZero) {
  LiveServer server;
  {
    link::HapticClient client = connect(server.url());
    press_on_skin(client);
  }
  server.kill(SIGTERM);
  ASSERT_TRUE(wait_for([&] { return !server.process().is_running(); }));
  EXPECT_EQ(server.process().how_it_ended(), "ended with exit status 0");
}

}  // namespace
}  // namespace trocar::servers_test
