// What a client may expect of a haptic server: the same of trocar-hapticd through the link, and of the simulated server
// with which other tests replace it.
#include <gtest/gtest.h>
#include <signal.h>

#include "attempt/servers/server_hosts.h"
#include "cases/scene_request.h"
#include "servers/live_server.h"
#include "servers/simulated_attempt_lab.h"

namespace trocar::servers_test {
namespace {

using attempt::ServerConnection;
using attempt::ServerHost;
using link::ServerCommand;

/// A server of one of the two kinds, and the time in which it runs.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual ServerHost& host() = 0;
  virtual void kill() = 0;
  virtual bool wait(const std::function<bool()>& is_so) = 0;
};

class LinkRig final : public Rig {
 public:
  LinkRig() {
    attempt::LocalServerOptions options;
    options.priority = 0;
    options.flight_folder = folder_.path();
    auto started = attempt::LocalServer::start(options);
    TROCAR_CHECK(started.has_value());
    server_ = *std::move(started);
  }
  ServerHost& host() override { return *server_; }
  void kill() override { ::kill(server_->pid(), SIGKILL); }
  bool wait(const std::function<bool()>& is_so) override { return wait_for(is_so); }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<attempt::LocalServer> server_;
};

class SimulatedRig final : public Rig {
 public:
  ServerHost& host() override { return *host_; }
  void kill() override { server_.kill(); }
  bool wait(const std::function<bool()>& is_so) override {
    for (int ms = 0; ms < 60'000 && !is_so(); ++ms) clock_.advance(std::chrono::milliseconds(1));
    return is_so();
  }

 private:
  testing::FakeClock clock_;
  SimulatedServer server_{clock_, prepared_case("layers-liver")->the_case.patient, {}};
  std::unique_ptr<ServerHost> host_ = server_.host();
};

template <class AnyRig>
class ConnectionContract : public ::testing::Test {
 protected:
  std::unique_ptr<ServerConnection> connect(bool wants_control = true) {
    link::ClientOptions options;
    options.wants_control = wants_control;
    auto connection = rig.host().connect(options);
    EXPECT_TRUE(connection) << connection.error().text();
    EXPECT_TRUE(rig.wait([&] { return (*connection)->view().status.loop.wanted_hz > 0.0; }));
    return *std::move(connection);
  }
  link::Reply ask(ServerConnection& connection, decltype(link::Command::what) what) {
    const std::uint32_t request = connection.send(std::move(what));
    link::Reply found;
    EXPECT_TRUE(rig.wait([&] {
      for (link::Reply& reply : connection.take_replies())
        if (reply.request == request) found = std::move(reply);
      return found.request == request;
    }));
    return found;
  }
  link::LoadScene scene() const {
    const auto open = prepared_case("layers-liver");
    cases::SceneChoice choice;
    choice.patient_source = "layers-liver";
    return cases::scene_request(open->the_case, choice);
  }

  AnyRig rig;
};
using Rigs = ::testing::Types<LinkRig, SimulatedRig>;
TYPED_TEST_SUITE(ConnectionContract, Rigs);

TYPED_TEST(ConnectionContract, WelcomesTheFirstClientWithControl) {
  const auto connection = this->connect();
  const link::ClientView view = connection->view();
  EXPECT_TRUE(view.is_connected);
  EXPECT_NE(view.welcome.session, 0u);
  EXPECT_TRUE(view.welcome.has_control);
  EXPECT_EQ(view.welcome.tool, "needle");
  EXPECT_EQ(view.welcome.device.name, "virtual:premium");
  EXPECT_EQ(view.status.fault, telemetry::GateFault::kNone);
  const auto second = this->connect();
  EXPECT_FALSE(second->view().welcome.has_control);
  EXPECT_FALSE(this->ask(*second, ServerCommand::kStart).is_done);
}

TYPED_TEST(ConnectionContract, AllowsAWatcherToStopTheForces) {
  const auto connection = this->connect();
  const auto watcher = this->connect(false);
  ASSERT_TRUE(this->ask(*connection, this->scene()).is_done);
  ASSERT_TRUE(this->ask(*connection, ServerCommand::kStart).is_done);
  ASSERT_TRUE(this->rig.wait([&] { return watcher->view().status.gate_mode != telemetry::GateMode::kOff; }));
  const link::Reply stopped = this->ask(*watcher, ServerCommand::kStop);
  EXPECT_TRUE(stopped.is_done) << stopped.text;
  EXPECT_TRUE(this->rig.wait([&] { return connection->view().status.gate_mode == telemetry::GateMode::kOff; }));
  EXPECT_TRUE(connection->view().welcome.has_control);
}

TYPED_TEST(ConnectionContract, GivesControlToTheNextClientAfterGoodbye) {
  auto first = this->connect();
  const auto second = this->connect();
  EXPECT_FALSE(second->view().welcome.has_control);
  first.reset();
  EXPECT_TRUE(this->rig.wait([&] { return second->view().welcome.has_control; }));
}

TYPED_TEST(ConnectionContract, AnswersACommandWithItsNumber) {
  const auto connection = this->connect();
  const link::Reply refused = this->ask(*connection, ServerCommand::kStart);
  EXPECT_FALSE(refused.is_done);
  EXPECT_NE(refused.text.find("no scene loaded"), std::string::npos) << refused.text;
  EXPECT_TRUE(this->ask(*connection, ServerCommand::kStop).is_done);
}

TYPED_TEST(ConnectionContract, NumbersScenesAndTicks) {
  const auto connection = this->connect();
  const link::Reply loaded = this->ask(*connection, this->scene());
  ASSERT_TRUE(loaded.is_done) << loaded.text;
  EXPECT_EQ(loaded.scene, 1u);
  EXPECT_FALSE(loaded.tissues_toml.empty());
  const link::Reply changed = this->ask(*connection, cases::tissue_parameters({{"skin", "fp", 6.0}}));
  ASSERT_TRUE(changed.is_done) << changed.text;
  EXPECT_EQ(changed.scene, 2u);
  const link::Reply refused = this->ask(*connection, cases::tissue_parameters({{"skin", "colour", 6.0}}));
  EXPECT_FALSE(refused.is_done);
  connection->take_samples();
  std::vector<link::NumberedSample> samples;
  ASSERT_TRUE(this->rig.wait([&] {
    for (const link::NumberedSample& sample : connection->take_samples()) samples.push_back(sample);
    return samples.size() > 100;
  }));
  EXPECT_EQ(samples.back().scene, 2u);
  EXPECT_GE(samples.back().tick - samples.front().tick, samples.size() - 1);  // a busy machine leaves gaps
}

TYPED_TEST(ConnectionContract, SwitchesTheForcesOffWhenItsControllerLeaves) {
  auto connection = this->connect();
  const auto watcher = this->connect(false);
  ASSERT_TRUE(this->ask(*connection, this->scene()).is_done);
  ASSERT_TRUE(this->ask(*connection, ServerCommand::kStart).is_done);
  ASSERT_TRUE(this->rig.wait([&] { return watcher->view().status.gate_mode != telemetry::GateMode::kOff; }));
  connection.reset();
  EXPECT_TRUE(this->rig.wait([&] { return watcher->view().status.gate_mode == telemetry::GateMode::kOff; }));
}

TYPED_TEST(ConnectionContract, StartsANewSessionAfterARestart) {
  const auto connection = this->connect();
  const std::uint64_t session = connection->view().welcome.session;
  ASSERT_TRUE(this->ask(*connection, this->scene()).is_done);
  this->rig.kill();
  ASSERT_TRUE(this->rig.wait([&] { return !this->rig.host().check() && connection->view().silent_s > 0.3; }));
  EXPECT_FALSE(connection->view().is_connected);
  EXPECT_FALSE(this->ask(*connection, ServerCommand::kStop).is_done);
  ASSERT_TRUE(this->rig.host().restart());
  ASSERT_TRUE(this->rig.wait([&] {
    const link::ClientView view = connection->view();
    return view.is_connected && view.welcome.session != session && view.status.loop.wanted_hz > 0.0;
  }));
  const link::Reply loaded = this->ask(*connection, this->scene());
  EXPECT_TRUE(loaded.is_done) << loaded.text;
  EXPECT_EQ(loaded.scene, 1u);
}

}  // namespace
}  // namespace trocar::servers_test
