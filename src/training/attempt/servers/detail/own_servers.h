#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/offline/run_session.h"
#include "attempt/servers/local_server.h"

namespace trocar::attempt {

/// Two servers of our own, needle and probe, with simulated devices. They end with this.
class OwnServers {
 public:
  /// Flight records of a fault are written beside the session. Errors: no trocar-hapticd, it cannot be started.
  static Result<OwnServers> start(const RunOptions& options, double rate_hz);

  std::vector<std::string> endpoints() const;
  /// Error: that tool's server has ended, with the last line of its log.
  Status check(std::string_view tool);

 private:
  std::vector<std::unique_ptr<LocalServer>> servers_;
};

}  // namespace trocar::attempt
