#include "servers/live_server.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <thread>

#include "cases/scene_request.h"

namespace trocar::servers_test {
namespace {
const Vec3 kEntry_P(0.0, -45.0, 0.0);  // on the skin of the layered patients; the body is at +y
}

bool wait_for(const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

LiveServer::LiveServer(std::vector<std::string> more) : url_("ipc://" + (folder_ / "needle").string()) {
  arguments_ = {"--endpoint", url_, "--priority", "0", "--flight-records", folder_.path().string()};
  arguments_.insert(arguments_.end(), more.begin(), more.end());
  start();
}

void LiveServer::start() {
  const auto program = link::find_server_program();
  ASSERT_TRUE(program) << program.error().text();
  auto process = link::ServerProcess::start(*program, arguments_, folder_ / "log");
  ASSERT_TRUE(process) << process.error().text();
  process_.emplace(std::move(*process));
}

void LiveServer::kill(int signal) {
  ::kill(process_->pid(), signal);
}

link::HapticClient connect(const std::string& url, bool wants_control) {
  link::ClientOptions options;
  options.endpoint = url;
  options.wants_control = wants_control;
  auto client = link::HapticClient::connect(options);
  EXPECT_TRUE(client) << client.error().text();
  const Status connected = client->wait_connected(kPatience);
  EXPECT_TRUE(connected);
  return std::move(*client);
}

link::LoadScene layers_scene() {
  link::LoadScene scene;
  scene.patient = "layers-liver";
  scene.X_PW = cases::room_in_patient({kEntry_P, kEntry_P + 40.0 * Vec3::UnitY()}, scene.needle_length_mm);
  return scene;
}

link::HandTarget hand_at_depth(double depth_mm) {
  link::HandTarget hand;
  hand.X_PN = needle_pose(kEntry_P + depth_mm * Vec3::UnitY(), Vec3::UnitY());
  hand.holds_tip = true;
  return hand;
}

namespace {

/// A busy machine can make a loop slow or stop it: such a fault is reset, as a seat with a simulated device does.
void reset_loop_fault(link::HapticClient& client) {
  const telemetry::GateFault fault = client.view().status.fault;
  if (fault == telemetry::GateFault::kLoopSlow || fault == telemetry::GateFault::kLoopStalled)
    client.ask(link::ServerCommand::kResetFault, kPatience);
}

}  // namespace

void press_on_skin(link::HapticClient& client, double* pressed_mm) {
  const auto loaded = client.ask(layers_scene(), kPatience);
  ASSERT_TRUE(loaded) << loaded.error().text();
  link::HandTarget hand = hand_at_depth(-5.0);
  hand.is_placed = true;
  client.set_hand(hand);
  ASSERT_TRUE(client.ask(link::ServerCommand::kStart, kPatience));
  ASSERT_TRUE(wait_for([&] {
    reset_loop_fault(client);
    return client.view().status.gate_mode == telemetry::GateMode::kOn;
  })) << to_string(client.view().status.gate_mode);
  double depth_mm = -5.0;
  ASSERT_TRUE(wait_for([&] { return keep_pressing(client, 0.5, depth_mm); }));
  if (pressed_mm != nullptr) *pressed_mm = depth_mm;
}

bool keep_pressing(link::HapticClient& client, double least_n, double& depth_mm) {
  reset_loop_fault(client);
  const auto newest = client.newest();
  if (newest && felt_n(*newest) > least_n) return true;
  // Not through the skin, however late the forces come; a hand that felt nothing begins again.
  constexpr double kStep_mm = 0.02, kDeepest_mm = 8.0, kOutside_mm = -5.0;
  depth_mm = depth_mm < kDeepest_mm ? depth_mm + kStep_mm : kOutside_mm;
  client.set_hand(hand_at_depth(depth_mm));
  return false;
}

double felt_n(const telemetry::TickSample& sample) {
  return (sample.device_f_n - sample.f_weight_n).norm();
}

bool has_limit(const telemetry::TickSample& sample, telemetry::LimitReason reason) {
  for (const telemetry::TickEvent& event : sample.events) {
    if (event.kind == telemetry::EventKind::kLimit && event.id == static_cast<std::uint8_t>(reason)) return true;
  }
  return false;
}

}  // namespace trocar::servers_test
