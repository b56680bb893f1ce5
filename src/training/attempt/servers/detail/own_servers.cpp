#include "attempt/servers/detail/own_servers.h"

namespace trocar::attempt {

Result<OwnServers> OwnServers::start(const RunOptions& options, double rate_hz) {
  OwnServers own;
  for (const char* tool : {"needle", "probe"}) {
    LocalServerOptions of_tool;
    of_tool.tool = tool;
    of_tool.device = "virtual:" + options.device;
    of_tool.rate_hz = rate_hz;
    of_tool.flight_folder = options.session.parent_path();
    TROCAR_TRY(std::unique_ptr<LocalServer> server, LocalServer::start(of_tool));
    own.servers_.push_back(std::move(server));
  }
  return own;
}

std::vector<std::string> OwnServers::endpoints() const {
  std::vector<std::string> all;
  for (const auto& server : servers_) all.push_back(server->endpoint());
  return all;
}

Status OwnServers::check(std::string_view tool) {
  for (const auto& server : servers_)
    if (server->tool() == tool) return server->check();
  return {};
}

}  // namespace trocar::attempt
