// Flight records of a whole server: told at the start if they cannot be written, and kept while a scene is loaded.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "server/test/server_rig.h"

namespace trocar::server {
namespace {

using testing::kServerPatience;
using testing::wait_for;

/// A device that can be unplugged.
class LosableDevice final : public devices::HapticDevice {
 public:
  explicit LosableDevice(const std::atomic<bool>& is_lost) : is_lost_(is_lost) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "losable"; }
  devices::DeviceReading read(double) noexcept override {
    devices::DeviceReading reading;
    if (is_lost_) reading.status = devices::DeviceStatus::kDisconnected;
    return reading;
  }
  bool write(const Wrench&) noexcept override { return true; }
  Status reconnect() override { return {}; }

 private:
  stylus::DevicePreset preset_ = testing::device_preset();
  const std::atomic<bool>& is_lost_;
};

struct FlightRig {
  explicit FlightRig(const std::filesystem::path& flights) {
    ServerOptions options;
    options.endpoint = *link::parse_endpoint("ipc://" + (folder / "needle").string());
    options.priority = 0;
    options.tissues_file = testing::data_file("tissues.toml");
    options.flight_folder = flights;
    const auto opener = [this](const std::string&, std::uint64_t,
                               const Progress&) -> Result<std::shared_ptr<const anatomy::VirtualPatient>> {
      while (is_loading) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return fail("there is no such patient", "test");
    };
    auto started = HapticServer::start(options, std::make_unique<LosableDevice>(is_lost), opener);
    TROCAR_CHECK(started.has_value());
    server.emplace(std::move(*started));
    link::ClientOptions client_options;
    client_options.endpoint = server->url();
    auto connected = link::HapticClient::connect(client_options);
    TROCAR_CHECK(connected && connected->wait_connected(kServerPatience));
    client.emplace(std::move(*connected));
  }
  ~FlightRig() { is_loading = false; }

  const TemporaryFolder folder;
  std::atomic<bool> is_lost{false}, is_loading{true};
  std::optional<HapticServer> server;
  std::optional<link::HapticClient> client;
};

TEST(FlightKeeping, WarnsAtStartIfRecordsCannotBeWritten) {
  FlightRig rig("/proc/none");
  EXPECT_TRUE(wait_for([&] { return rig.client->view().status.ticks > 0; }));
  const std::string warning = rig.client->view().status.warning;
  EXPECT_NE(warning.find("flight records cannot be written"), std::string::npos) << warning;
  EXPECT_NE(warning.find("/proc/none"), std::string::npos) << warning;
}

TEST(FlightKeeping, KeepsTheRecordOfAFaultDuringALoad) {
  const TemporaryFolder flights;
  FlightRig rig(flights.path());
  rig.client->send(testing::layered_request());
  ASSERT_TRUE(wait_for([&] { return rig.client->view().status.loading > 0.0; }));
  rig.is_lost = true;
  ASSERT_TRUE(wait_for([&] { return rig.client->view().status.fault != telemetry::GateFault::kNone; }));
  const ServerReport report = rig.server->stop();
  EXPECT_TRUE(report.is_loading) << "the control thread is still busy";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(flights.path())) {
    EXPECT_NE(entry.path().filename().string().find("device_lost"), std::string::npos) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 1u);
  rig.is_loading = false;
}

}  // namespace
}  // namespace trocar::server
