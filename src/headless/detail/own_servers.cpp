#include "headless/detail/own_servers.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

namespace trocar {
namespace {

constexpr std::array kTools{"needle", "probe"};

std::string last_line(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

std::string OwnServers::endpoint_of(const std::string& tool) const {
  return "ipc://" + (*folder_ / tool).string();
}

Result<OwnServers> OwnServers::start(const RunOptions& options, double rate_hz) {
  TROCAR_TRY(const std::filesystem::path program, find_server_program());
  OwnServers own(std::make_unique<TemporaryFolder>());
  const std::filesystem::path beside = options.session.parent_path();
  for (const std::string tool : kTools) {
    const std::vector<std::string> arguments{"--device",         "virtual:" + options.device,
                                             "--tool",           tool,
                                             "--rate",           fmt::format("{}", rate_hz),
                                             "--endpoint",       own.endpoint_of(tool),
                                             "--flight-records", beside.empty() ? "." : beside.string()};
    TROCAR_TRY(ServerProcess process, ServerProcess::start(program, arguments, *own.folder_ / (tool + ".log")));
    own.servers_.push_back({tool, std::move(process)});
  }
  return own;
}

std::vector<std::string> OwnServers::endpoints() const {
  std::vector<std::string> all;
  for (const Server& server : servers_) all.push_back(endpoint_of(server.tool));
  return all;
}

Status OwnServers::check(std::string_view tool) {
  for (Server& server : servers_) {
    if (server.tool != tool || server.process.is_running()) continue;
    return fail(fmt::format("the server of the {} {}", server.tool, server.process.how_it_ended()), "trocar-hapticd",
                last_line(*folder_ / (server.tool + ".log")));
  }
  return {};
}

}  // namespace trocar
