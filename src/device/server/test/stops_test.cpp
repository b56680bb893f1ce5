// Stops through a whole server: by any client, under a flood of commands, and when control changes.
#include <gtest/gtest.h>

#include "link/test/raw_link.h"
#include "server/test/server_rig.h"

namespace trocar::server {
namespace {

using link::ServerCommand;
using testing::kServerPatience;
using testing::ServerRig;
using testing::turn_on;
using testing::wait_for;

constexpr int kFlood = 150;  ///< More than the queue of the real-time thread holds.

/// A machine too busy for the loop's period has latched a fault: the forces are off then, too.
bool is_off(const link::HapticClient& client) {
  const link::ServerStatus status = client.view().status;
  const bool is_ready = status.state == link::ServerState::kReady && status.gate_mode == telemetry::GateMode::kOff;
  return is_ready || status.fault != telemetry::GateFault::kNone;
}

/// True if the forces go off and stay so: many ticks in a row have no force on the device, more than a full queue takes
/// to be emptied.
bool goes_off(link::HapticClient& client) {
  constexpr int kTicks = 200;
  int without = 0;
  const bool is_enough = wait_for([&] {
    for (const link::NumberedSample& numbered : client.take_samples())
      without = numbered.sample.device_f_n.norm() > 0.0 ? 0 : without + 1;
    return without >= kTicks;
  });
  return is_enough && wait_for([&] { return is_off(client); });
}

bool wait_for_controller(const link::HapticClient& watcher, bool has_controller) {
  return wait_for([&] {
    const link::ServerStatus status = watcher.view().status;
    return status.ticks > 0 && status.has_controller == has_controller;
  });
}

/// A client that sends commands without waiting for replies.
class FloodingClient {
 public:
  explicit FloodingClient(const std::string& url) : raw_(url) {
    raw_.connect();
    EXPECT_TRUE(raw_.hello("flood"));
    EXPECT_TRUE(raw_.next<link::Welcome>());
  }
  bool has_done(decltype(link::Command::what) what) {
    raw_.send(link::Command{++request_, std::move(what)});
    while (const auto reply = raw_.next<link::Reply>())
      if (reply->request == request_) return reply->is_done;
    return false;
  }
  void flood() {
    for (int i = 0; i < kFlood; ++i) raw_.send(link::Command{++request_, ServerCommand::kStart});
  }
  testing::RawClient& raw() { return raw_; }

 private:
  testing::RawClient raw_;
  std::uint32_t request_ = 0;
};

TEST(Stops, AreNotLostAfterAFloodOfStarts) {
  ServerRig rig;
  link::HapticClient watcher = rig.connect(false);
  FloodingClient client(rig.server().url());
  ASSERT_TRUE(client.has_done(testing::layered_request()));
  for (int round = 0; round < 3; ++round) {
    watcher.take_samples();
    client.flood();
    ASSERT_TRUE(client.has_done(ServerCommand::kStop)) << round;
    EXPECT_TRUE(goes_off(watcher)) << round;
  }
}

TEST(Stops, AreAllowedToAWatcherThatCannotStart) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  ASSERT_TRUE(client.ask(testing::layered_request(), kServerPatience));
  ASSERT_TRUE(turn_on(client));
  link::HapticClient watcher = rig.connect(false), waiting = rig.connect(true);
  for (link::HapticClient* other : {&watcher, &waiting}) {
    client.take_samples();
    EXPECT_FALSE(other->ask(ServerCommand::kStart, kServerPatience));
    EXPECT_FALSE(other->ask(ServerCommand::kResetFault, kServerPatience));
    const auto stopped = other->ask(ServerCommand::kStop, kServerPatience);
    EXPECT_TRUE(stopped) << stopped.error().text();
    EXPECT_TRUE(goes_off(client));
    EXPECT_TRUE(client.view().welcome.has_control) << "a stop does not take control";
    ASSERT_TRUE(turn_on(client));
  }
}

TEST(Stops, GoodbyeOfTheLastControllerStopsForces) {
  ServerRig rig;
  link::HapticClient watcher = rig.connect(false);
  {
    FloodingClient client(rig.server().url());
    ASSERT_TRUE(client.has_done(testing::layered_request()));
    ASSERT_TRUE(client.has_done(ServerCommand::kStart));
    ASSERT_TRUE(wait_for_controller(watcher, true));
    client.flood();
    client.raw().send(link::Goodbye{});
    ASSERT_TRUE(wait_for_controller(watcher, false));
  }
  EXPECT_TRUE(goes_off(watcher));
}

TEST(Stops, TheNextClientGetsControlWithForcesOff) {
  ServerRig rig;
  link::HapticClient next = [&] {
    FloodingClient client(rig.server().url());
    link::HapticClient waiting = rig.connect();
    EXPECT_TRUE(client.has_done(testing::layered_request()));
    EXPECT_FALSE(waiting.view().welcome.has_control);
    client.flood();
    client.raw().send(link::Goodbye{});
    EXPECT_TRUE(wait_for([&] { return waiting.view().welcome.has_control; }));
    return waiting;
  }();
  EXPECT_TRUE(goes_off(next));
  EXPECT_TRUE(turn_on(next));
}

TEST(Stops, StartThatAcquiresControlTakesEffect) {
  ServerRig rig;
  link::HapticClient watcher = rig.connect(false);
  FloodingClient first(rig.server().url()), second(rig.server().url());
  ASSERT_TRUE(first.has_done(testing::layered_request()));
  ASSERT_TRUE(wait_for_controller(watcher, true));
  first.raw().send(link::Goodbye{});
  ASSERT_TRUE(wait_for_controller(watcher, false));
  ASSERT_TRUE(second.has_done(ServerCommand::kStart));
  EXPECT_TRUE(wait_for([&] {
    const link::ServerState state = watcher.view().status.state;
    return state == link::ServerState::kRunning || state == link::ServerState::kFault;
  }));
}

TEST(Stops, ASilentClientLosesControlWithForcesOff) {
  ServerRig rig;
  FloodingClient silent(rig.server().url());
  ASSERT_TRUE(silent.has_done(testing::layered_request()));
  ASSERT_TRUE(silent.has_done(ServerCommand::kStart));
  link::HapticClient next = rig.connect();  // gets control when the other was silent for kControlLost_s
  ASSERT_TRUE(wait_for([&] { return next.view().welcome.has_control; }));
  EXPECT_TRUE(goes_off(next));
}

TEST(Stops, NewControllerSessionStartsWithForcesOff) {
  ServerRig rig;
  link::HapticClient watcher = rig.connect(false);
  FloodingClient client(rig.server().url());
  ASSERT_TRUE(client.has_done(testing::layered_request()));
  ASSERT_TRUE(client.has_done(ServerCommand::kStart));
  ASSERT_TRUE(client.raw().hello("flood"));
  const auto welcome = client.raw().next<link::Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_TRUE(welcome->has_control);
  EXPECT_TRUE(goes_off(watcher));
}

}  // namespace
}  // namespace trocar::server
