#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "core/files/folders.h"
#include "link/client/haptic_client.h"
#include "server/haptic_server.h"
#include "server/test/servo_rig.h"

namespace trocar::testing {

/// Long enough for a loaded machine; nothing is measured by it.
inline constexpr std::chrono::seconds kServerPatience(20);

inline bool wait_for(const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + kServerPatience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// Forces on. A machine too busy for the loop's period has latched a fault: it is reset, as a person would.
inline bool turn_on(link::HapticClient& client) {
  return wait_for([&] {
    const telemetry::GateMode mode = client.view().status.gate_mode;
    if (mode == telemetry::GateMode::kOn) return true;
    const bool is_fault = mode == telemetry::GateMode::kFault;
    const bool is_off = is_fault || mode == telemetry::GateMode::kOff;
    EXPECT_TRUE(!is_fault || client.ask(link::ServerCommand::kResetFault, kServerPatience));
    EXPECT_TRUE(!is_off || client.ask(link::ServerCommand::kStart, kServerPatience));
    return false;
  });
}

/// A server with a scripted device on an endpoint of its own, and a client.
class ServerRig {
 public:
  ServerRig() : server_(start()) {}

  server::HapticServer start() {
    server::ServerOptions options;
    options.endpoint = *link::parse_endpoint("ipc://" + (folder_ / "needle").string());
    options.priority = 0;
    options.tissues_file = data_file("tissues.toml");
    options.flight_folder = folder_.path();
    auto device = std::make_unique<ScriptedDevice>(device_preset());
    device->reading.X_DS = needle_at_depth(-10.0);
    device_ = device.get();
    auto server = server::HapticServer::start(options, std::move(device), layered_opener());
    TROCAR_CHECK(server.has_value());
    return std::move(*server);
  }
  link::HapticClient connect(bool wants_control = true) {
    link::ClientOptions options;
    options.endpoint = server_.url();
    options.wants_control = wants_control;
    auto client = link::HapticClient::connect(options);
    TROCAR_CHECK(client.has_value());
    TROCAR_CHECK(client->wait_connected(kServerPatience).has_value());
    return std::move(*client);
  }
  server::HapticServer& server() { return server_; }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
  ScriptedDevice* device_ = nullptr;
  server::HapticServer server_;
};

}  // namespace trocar::testing
