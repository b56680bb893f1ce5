#include "headless/own_server.h"

#include <fmt/format.h>

#include <fstream>

namespace trocar {
namespace {

constexpr const char* kLog = "log";

std::string last_line(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

Result<OwnServer> OwnServer::start(const OwnServerOptions& options) {
  OwnServer server;
  server.options_ = options;
  server.folder_ = std::make_unique<TemporaryFolder>();
  server.endpoint_ = "ipc://" + (*server.folder_ / options.tool).string();
  TROCAR_TRY_STATUS(server.restart());
  return server;
}

Status OwnServer::restart() {
  TROCAR_TRY(const std::filesystem::path program, find_server_program());
  const std::string flights = options_.flight_folder.empty() ? "." : options_.flight_folder.string();
  const std::vector<std::string> arguments{"--device",         options_.device,
                                           "--tool",           options_.tool,
                                           "--rate",           fmt::format("{}", options_.rate_hz),
                                           "--priority",       fmt::format("{}", options_.priority),
                                           "--endpoint",       endpoint_,
                                           "--flight-records", flights};
  process_.reset();
  TROCAR_TRY(ServerProcess process, ServerProcess::start(program, arguments, *folder_ / kLog));
  process_ = std::make_unique<ServerProcess>(std::move(process));
  return {};
}

Status OwnServer::check() {
  if (process_ && process_->is_running()) return {};
  return fail(fmt::format("the server of the {} {}", options_.tool,
                          process_ ? process_->how_it_ended() : "could not be started again"),
              "trocar-hapticd", last_line(*folder_ / kLog));
}

}  // namespace trocar
