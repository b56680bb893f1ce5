#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/temporary_folder.h"
#include "headless/run_session.h"
#include "link/server_process.h"

namespace trocar {

/// Two servers of our own, needle and probe, with simulated devices, on sockets in a folder of their own. They end with
/// this.
class OwnServers {
 public:
  /// Flight records of a fault are written beside the session. Errors: no trocar-hapticd, it cannot be started.
  static Result<OwnServers> start(const RunOptions& options, double rate_hz);

  std::vector<std::string> endpoints() const;
  /// Error: that tool's server has ended, with the last line of its log.
  Status check(std::string_view tool);

 private:
  struct Server {
    std::string tool;
    ServerProcess process;
  };
  explicit OwnServers(std::unique_ptr<TemporaryFolder> folder) : folder_(std::move(folder)) {}
  std::string endpoint_of(const std::string& tool) const;

  std::unique_ptr<TemporaryFolder> folder_;
  std::vector<Server> servers_;
};

}  // namespace trocar
