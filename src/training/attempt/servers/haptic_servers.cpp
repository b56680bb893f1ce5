#include "attempt/servers/haptic_servers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <utility>

#include "attempt/servers/server_host.h"
#include "core/files/folders.h"
#include "core/interruption.h"

namespace trocar::attempt {
namespace {

bool is_same(const std::optional<LocalServerOptions>& a, const std::optional<LocalServerOptions>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->device == b->device && a->rate_hz == b->rate_hz && a->priority == b->priority;
}

/// A server and its supervisor.
struct Found {
  std::unique_ptr<ServerHost> host;
  std::unique_ptr<ServerSupervisor> supervisor;  ///< Ends before its host.
};

Status wait_until_idle(const std::vector<Found>& all, Clock& clock, const Progress& progress) {
  constexpr std::chrono::milliseconds kBetweenPolls{1};
  const auto is_idle = [](const Found& one) { return one.supervisor->state() == ServerState::kIdle; };
  while (!std::ranges::all_of(all, is_idle)) {
    if (is_interrupted()) return tl::unexpected(interruption_error("trocar run"));
    report(progress, "waiting for the haptic servers", 0.0);
    for (const Found& one : all) {
      one.supervisor->poll();
      if (one.supervisor->state() == ServerState::kFailed) return tl::unexpected(one.supervisor->failure());
    }
    clock.sleep_for(kBetweenPolls);
  }
  return {};
}

}  // namespace

HapticServers::HapticServers(std::unique_ptr<ServerHost> needle, std::unique_ptr<ServerHost> transducer)
    : needle_(std::move(needle)), transducer_(std::move(transducer)) {}

Result<std::shared_ptr<HapticServers>> HapticServers::start(const LocalServerOptions& needle,
                                                            const std::optional<LocalServerOptions>& transducer) {
  TROCAR_TRY(std::unique_ptr<ServerHost> of_needle, LocalServer::start(needle));
  std::unique_ptr<ServerHost> of_transducer;
  if (transducer) {
    TROCAR_TRY(of_transducer, LocalServer::start(*transducer));
  }
  auto servers = std::make_shared<HapticServers>(std::move(of_needle), std::move(of_transducer));
  servers->needle_options_ = needle;
  servers->transducer_options_ = transducer;
  return servers;
}

bool HapticServers::fits(const LocalServerOptions& needle, const std::optional<LocalServerOptions>& transducer) const {
  return is_same(needle_options_, needle) && is_same(transducer_options_, transducer);
}

ToolSupervisors HapticServers::supervise(const SupervisionOptions& options, Clock& clock) {
  ToolSupervisors supervisors;
  supervisors.needle = std::make_unique<ServerSupervisor>(*needle_, options, clock);
  if (transducer_) supervisors.transducer = std::make_unique<ServerSupervisor>(*transducer_, options, clock);
  return supervisors;
}

Result<IdentifiedServers> identify_servers(std::vector<std::unique_ptr<ServerHost>> hosts,
                                           const SupervisionOptions& options, Clock& clock, const Progress& progress) {
  std::vector<Found> all;
  for (std::unique_ptr<ServerHost>& host : hosts) {
    auto supervisor = std::make_unique<ServerSupervisor>(*host, options, clock);
    all.push_back({std::move(host), std::move(supervisor)});
  }
  TROCAR_TRY_STATUS(wait_until_idle(all, clock, progress));
  Found needle, transducer;
  for (Found& one : all) {
    const std::string& tool = one.supervisor->tool();
    Found* const place = tool == "needle" ? &needle : tool == "probe" ? &transducer : nullptr;
    if (place == nullptr || place->host != nullptr)
      return fail(
          fmt::format("{} server of the {} is not needed for an attempt", place == nullptr ? "the" : "a second", tool),
          one.host->endpoint(), "name one of the needle and at most one of the probe");
    *place = std::move(one);
  }
  if (needle.host == nullptr) {
    const std::string endpoint = transducer.host == nullptr ? std::string() : transducer.host->endpoint();
    return fail("no needle server among the endpoints", endpoint, "start trocar-hapticd --tool needle");
  }
  return IdentifiedServers{std::make_shared<HapticServers>(std::move(needle.host), std::move(transducer.host)),
                           {std::move(needle.supervisor), std::move(transducer.supervisor)}};
}

namespace {

namespace fs = std::filesystem;

struct DeviceTitle {
  std::string_view spec;
  std::string_view title;
};
constexpr std::string_view kOpenHaptics = "openhaptics";
constexpr std::string_view kDefaultName = "Default Device";  // default of the vendor's library
constexpr std::array kPointers{DeviceTitle{"mouse", "Mouse and keyboard"}, DeviceTitle{"gamepad", "Gamepad"},
                               DeviceTitle{"spacemouse", "SpaceMouse"}};
constexpr std::array kOthers{DeviceTitle{"forcedimension", "Force Dimension"}, DeviceTitle{"haply", "Haply Inverse3"}};

/// Device names assigned in the vendor's setup program, in order.
std::vector<std::string> openhaptics_names() {
  const char* home = std::getenv("GTDD_HOME");
  const fs::path folder = fs::path(home != nullptr && *home != '\0' ? home : "/usr/share/3DSystems") / "config";
  std::vector<std::string> names;
  const auto files = list_folder(folder);
  if (!files) return names;
  for (const fs::path& file : *files)
    if (file.extension() == ".config") names.push_back(file.stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The hardware of a spec.
std::string hardware_of(const std::string& spec) {
  return spec == kOpenHaptics ? spec + ":" + std::string(kDefaultName) : spec;
}

}  // namespace

std::vector<ToolDevice> tool_devices() {
  std::vector<ToolDevice> devices;
  for (const DeviceTitle& pointer : kPointers)
    devices.push_back({std::string(pointer.spec), std::string(pointer.title)});
  const std::vector<std::string> names = openhaptics_names();
  if (names.empty()) devices.push_back({std::string(kOpenHaptics), device_title(std::string(kOpenHaptics))});
  for (const std::string& name : names) {
    const std::string spec = std::string(kOpenHaptics) + ":" + name;
    devices.push_back({spec, device_title(spec)});
  }
  for (const DeviceTitle& other : kOthers) devices.push_back({std::string(other.spec), std::string(other.title)});
  return devices;
}

std::string device_title(const std::string& spec) {
  if (spec == kOpenHaptics) return "3D Systems Touch (OpenHaptics)";
  for (const auto& titles :
       {std::vector(kPointers.begin(), kPointers.end()), std::vector(kOthers.begin(), kOthers.end())})
    for (const DeviceTitle& device : titles)
      if (device.spec == spec) return std::string(device.title);
  const std::size_t colon = spec.find(':');
  if (colon == std::string::npos) return spec;
  const std::string kind = spec.substr(0, colon), name = spec.substr(colon + 1);
  return name + (kind == kOpenHaptics ? " (OpenHaptics)" : " (" + device_title(kind) + ")");
}

bool can_be_used_together(const std::string& needle_spec, const std::string& probe_spec) {
  if (follows_targets(needle_spec) || follows_targets(probe_spec)) return true;
  return hardware_of(needle_spec) != hardware_of(probe_spec);
}

}  // namespace trocar::attempt
