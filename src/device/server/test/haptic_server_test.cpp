#include "server/haptic_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "core/files/folders.h"
#include "core/random.h"
#include "link/client/haptic_client.h"
#include "link/codec.h"
#include "link/test/raw_link.h"
#include "server/test/server_rig.h"

namespace trocar::server {
namespace {

using namespace std::chrono_literals;
using testing::kServerPatience;
using testing::ScriptedDevice;
using testing::ServerRig;
using testing::turn_on;
using testing::wait_for;

TEST(HapticServer, LoadsASceneAndRuns) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  const auto loaded = client.ask(testing::layered_request(), kServerPatience);
  ASSERT_TRUE(loaded) << loaded.error().text();
  ASSERT_TRUE(client.ask(link::ServerCommand::kStart, kServerPatience));
  EXPECT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kRunning; }));
  EXPECT_TRUE(turn_on(client));
  EXPECT_EQ(client.view().status.patient, "layers");
  EXPECT_FALSE(client.view().status.grant.empty());
  EXPECT_TRUE(client.ask(link::ServerCommand::kStop, kServerPatience));
  EXPECT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kReady; }));
}

TEST(HapticServer, SendsEveryTickOrCountsIt) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  std::uint64_t expected = 0, seen = 0, gaps = 0;
  const bool is_enough = wait_for([&] {
    for (const link::NumberedSample& numbered : client.take_samples()) {
      if (seen > 0) gaps += numbered.tick - expected;
      expected = numbered.tick + 1;
      ++seen;
    }
    return seen >= 1000;
  });
  EXPECT_TRUE(is_enough);
  EXPECT_EQ(gaps, client.view().ticks_missing);
}

/// The reply to a command, when it comes.
link::Reply reply_to(link::HapticClient& client, std::uint32_t request) {
  link::Reply found;
  EXPECT_TRUE(wait_for([&] {
    for (link::Reply& reply : client.take_replies())
      if (reply.request == request) found = std::move(reply);
    return found.request == request;
  }));
  return found;
}

TEST(HapticServer, NumbersTheTicksOfAScene) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  const link::Reply loaded = reply_to(client, client.send(testing::layered_request()));
  ASSERT_TRUE(loaded.is_done) << loaded.text;
  ASSERT_GT(loaded.scene, 0U);
  link::SetParameters parameters;
  parameters.tissues = std::vector<link::TissueSetting>{{"skin", "fp", 6.0}};
  parameters.coupling_stiffness_n_per_mm = 0.5;
  const link::Reply changed = reply_to(client, client.send(parameters));
  ASSERT_TRUE(changed.is_done) << changed.text;
  EXPECT_GT(changed.scene, loaded.scene);
  const auto table = anatomy::parse_tissue_table(changed.tissues_toml, "reply");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->layers[*table->find_layer("skin")].puncture_force_n, 6.0);
  EXPECT_NE(std::ranges::find(changed.options, "coupling.stiffness=0.5"), changed.options.end());
  std::vector<std::uint64_t> scenes;  // every number once, in the order of the ticks
  EXPECT_TRUE(wait_for([&] {
    for (const link::NumberedSample& numbered : client.take_samples())
      if (scenes.empty() || scenes.back() != numbered.scene) scenes.push_back(numbered.scene);
    return !scenes.empty() && scenes.back() == changed.scene;
  }));
  EXPECT_TRUE(std::ranges::is_sorted(scenes));
}

TEST(HapticServer, RefusesToStartWithoutAScene) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  const auto started = client.ask(link::ServerCommand::kStart, kServerPatience);
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().text().find("scene"), std::string::npos);
}

TEST(HapticServer, ReportsWhatIsWrongWithAScene) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  link::LoadScene request = testing::layered_request();
  request.patient = "nobody";
  const auto loaded = client.ask(request, kServerPatience);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().text().find("nobody"), std::string::npos);
  request = testing::layered_request();
  request.tool = "probe";
  EXPECT_FALSE(client.ask(request, kServerPatience)) << "this server holds the needle";
}

TEST(HapticServer, WatcherReceivesTicksButCannotCommand) {
  ServerRig rig;
  link::HapticClient master = rig.connect();
  ASSERT_TRUE(master.ask(testing::layered_request(), kServerPatience));
  link::HapticClient watcher = rig.connect(false);
  EXPECT_FALSE(watcher.ask(link::ServerCommand::kStart, kServerPatience));
  EXPECT_TRUE(wait_for([&] { return watcher.newest().has_value(); }));
}

TEST(HapticServer, SwitchesForcesOffWhenTheControllerLeaves) {
  ServerRig rig;
  {
    link::HapticClient client = rig.connect();
    ASSERT_TRUE(client.ask(testing::layered_request(), kServerPatience));
    ASSERT_TRUE(client.ask(link::ServerCommand::kStart, kServerPatience));
    EXPECT_TRUE(wait_for([&] { return client.view().status.state == link::ServerState::kRunning; }));
  }
  link::HapticClient next = rig.connect();
  EXPECT_TRUE(wait_for([&] { return next.view().status.state == link::ServerState::kReady; }));
}

TEST(HapticServer, WarnsOfAStalledClientWindow) {
  ServerRig rig;
  link::ClientOptions options;
  options.endpoint = rig.server().url();
  options.has_window = true;
  auto client = link::HapticClient::connect(options);
  ASSERT_TRUE(client);
  client->frame_drawn();
  EXPECT_TRUE(wait_for([&] { return client->view().status.warning.find("window") != std::string::npos; }));
  EXPECT_TRUE(wait_for([&] {
    client->frame_drawn();
    return client->view().status.warning.empty();
  }));
}

TEST(HapticServer, CountsBadMessagesAndKeepsForcesOn) {
  ServerRig rig;
  link::HapticClient client = rig.connect();
  ASSERT_TRUE(client.ask(testing::layered_request(), kServerPatience));
  ASSERT_TRUE(turn_on(client));

  testing::RawClient stranger(rig.server().url());
  stranger.connect();
  const link::Bytes good = link::encode(link::ClientMessage{1, 1, link::Heartbeat{}});
  Random random(3);
  constexpr int kRounds = 50;
  for (int i = 0; i < kRounds; ++i) {
    link::Bytes noise(1 + random.next() % 4000);
    for (std::byte& byte : noise) byte = static_cast<std::byte>(random.next());
    stranger.send(noise);
    stranger.send(std::span(good).first(random.next() % good.size()));  // truncated
    stranger.send(good);                                                // of no session
  }
  ASSERT_TRUE(stranger.hello("stranger"));
  const auto welcome = stranger.next<link::Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_FALSE(welcome->has_control);
  stranger.send(link::Bytes(link::kMostMessageBytes + 1));
  stranger.send(welcome->session, 5, link::Heartbeat{});
  stranger.send(welcome->session, 5, link::Heartbeat{});                              // replayed
  stranger.send(welcome->session, 6, link::Command{1, link::ServerCommand::kStart});  // not in control

  EXPECT_TRUE(wait_for([&] { return client.view().status.messages_refused >= 3 * kRounds + 3; }))
      << client.view().status.messages_refused;
  EXPECT_NE(client.view().status.gate_mode, telemetry::GateMode::kOff);  // a busy machine may have latched a fault
  EXPECT_EQ(client.view().status.state, link::ServerState::kRunning);
}

TEST(HapticServer, StopsStartedThreadsWhenOneFailsToStart) {
  for (const char* failing : {"control", "link", "real-time"}) {
    const TemporaryFolder folder;
    ServerOptions options;
    options.endpoint = *link::parse_endpoint("ipc://" + (folder / "needle").string());
    options.priority = 0;
    const auto starter = [&](const char* name, std::function<void()> body) -> Result<std::thread> {
      if (name == std::string_view(failing)) return fail("the thread does not start", name, "test");
      return start_thread(name, std::move(body));
    };
    const auto server = HapticServer::start(options, std::make_unique<ScriptedDevice>(testing::device_preset()),
                                            testing::layered_opener(), starter);
    ASSERT_FALSE(server) << failing;
    EXPECT_NE(server.error().text().find(failing), std::string::npos) << server.error().text();
  }
}

/// A healthy device is opened again under force: its motors are off then, whoever opens it.
class ReopenedDevice final : public devices::HapticDevice {
 public:
  struct Log {
    std::atomic<double> depth_mm{-10.0};
    std::atomic<int> reconnects{0};
    std::atomic<double> held_n{-1.0};  ///< Force on the motors when it was opened again.
    std::atomic<double> largest_rise_n{0.0};
  };
  explicit ReopenedDevice(Log& log) : preset_(testing::device_preset()), log_(log) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "reopened"; }
  devices::DeviceReading read(double now_s) noexcept override {
    devices::DeviceReading reading;
    reading.X_DS = testing::needle_at_depth(log_.depth_mm + 0.01 * std::sin(30.0 * now_s));
    return reading;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    const double written_n = wrench_D.force_n.norm();
    log_.largest_rise_n = std::max(log_.largest_rise_n.load(), written_n - last_n_);
    last_n_ = written_n;
    return true;
  }
  Status reconnect() override {
    log_.held_n = last_n_;
    last_n_ = 0.0;
    ++log_.reconnects;
    return {};
  }

 private:
  stylus::DevicePreset preset_;
  Log& log_;
  double last_n_ = 0.0;
};

TEST(HapticServer, FadesForcesAroundADeviceReopen) {
  const TemporaryFolder folder;
  ServerOptions options;
  options.endpoint = *link::parse_endpoint("ipc://" + (folder / "needle").string());
  options.priority = 0;
  options.tissues_file = testing::data_file("tissues.toml");
  ReopenedDevice::Log log;
  auto server = HapticServer::start(options, std::make_unique<ReopenedDevice>(log), testing::layered_opener());
  ASSERT_TRUE(server) << server.error().text();
  link::ClientOptions client_options;
  client_options.endpoint = server->url();
  auto client = link::HapticClient::connect(client_options);
  ASSERT_TRUE(client && client->wait_connected(kServerPatience));
  ASSERT_TRUE(client->ask(testing::layered_request(), kServerPatience));
  ASSERT_TRUE(turn_on(*client));
  // Pressed slowly, until something is felt; a busy machine may have latched a fault meanwhile.
  ASSERT_TRUE(wait_for([&] {
    if (log.depth_mm < 3.0) log.depth_mm = log.depth_mm + 0.01;
    const auto newest = client->newest();
    return newest && (newest->device_f_n.norm() > 1.0 || newest->gate_fault != telemetry::GateFault::kNone);
  }));
  log.largest_rise_n = 0.0;
  ASSERT_TRUE(client->ask(link::ServerCommand::kReconnect, kServerPatience));
  EXPECT_EQ(log.reconnects, 1);
  EXPECT_EQ(log.held_n, 0.0) << "the forces have faded before";
  const std::uint64_t ticks = client->view().status.ticks;
  EXPECT_TRUE(wait_for([&] { return client->view().status.ticks > ticks + 1500; }));
  server->stop();
  EXPECT_LT(log.largest_rise_n, 0.5) << "N in one period";
}

TEST(HapticServer, RefusesAnUnsupportedRate) {
  const TemporaryFolder folder;
  ServerOptions options;
  options.endpoint = *link::parse_endpoint("ipc://" + (folder / "needle").string());
  options.rate_hz = 100'000.0;
  const auto server = HapticServer::start(options, std::make_unique<ScriptedDevice>(testing::device_preset()),
                                          testing::layered_opener());
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::server
