#include "attempt/servers/haptic_servers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

}  // namespace trocar::attempt
