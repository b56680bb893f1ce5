#pragma once

#include <memory>
#include <string>

#include "attempt/servers/server_connection.h"
#include "core/result.h"

namespace trocar::attempt {

/// Process of a haptic server. Plug point: a process that this program started (local_server.h), a server that was
/// already running (remote_server.h), or a simulated server of a test.
class ServerHost {
 public:
  virtual ~ServerHost() = default;
  virtual const std::string& tool() const noexcept = 0;    ///< "needle", "probe"; empty: unknown before it replies.
  virtual const std::string& device() const noexcept = 0;  ///< In the form of trocar-hapticd --device; empty: unknown.
  virtual const std::string& endpoint() const noexcept = 0;
  virtual int pid() const = 0;    ///< 0: not a process of this program.
  virtual Status check() = 0;     ///< Error: the process has ended. Never for a remote server.
  virtual bool is_held_up() = 0;  ///< See link::ServerProcess. Always false for a remote server.
  virtual Status restart() = 0;   ///< Error for a remote server.
  /// Replaces `options.endpoint` and `options.security` by those of this server.
  virtual Result<std::unique_ptr<ServerConnection>> connect(link::ClientOptions options) = 0;
};

}  // namespace trocar::attempt
