#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "devices/device_spec.h"
#include "server/haptic_server.h"

namespace trocar::testing {

/// A haptic server in this process with a simulated device, at ordinary priority: the tests check the received data,
/// not its timing.
class LiveServer {
 public:
  LiveServer(const cases::Case& the_case, const std::string& tool, const TemporaryFolder& folder)
      : patient_(the_case.patient), tool_(tool), url_("ipc://" + (folder / tool).string()) {
    start();
  }

  const std::string& url() const { return url_; }
  void start() {
    auto endpoint = link::parse_endpoint(url_);
    devices::DeviceOptions device_options;
    device_options.devices_file = data_dir() / "devices.toml";
    auto device = devices::open_device({"virtual", "premium"}, device_options);
    ASSERT_TRUE(endpoint.has_value() && device.has_value());
    server::ServerOptions options;
    options.endpoint = *endpoint;
    options.tool = tool_;
    options.priority = 0;
    options.tissues_file = data_dir() / "tissues.toml";
    auto server =
        server::HapticServer::start(options, *std::move(device),
                                    [patient = patient_](const std::string&, std::uint64_t, const Progress&)
                                        -> Result<std::shared_ptr<const anatomy::VirtualPatient>> { return patient; });
    ASSERT_TRUE(server.has_value()) << server.error().text();
    server_.emplace(*std::move(server));
  }
  /// Destroys the server and its socket.
  void end() { server_.reset(); }

 private:
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::string tool_, url_;
  std::optional<server::HapticServer> server_;
};

}  // namespace trocar::testing
