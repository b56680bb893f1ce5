#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "attempt/servers/server_host.h"
#include "core/files/folders.h"
#include "link/client/server_process.h"

namespace trocar::attempt {

/// Options of a trocar-hapticd that this program starts.
struct LocalServerOptions {
  std::string tool = "needle";             ///< needle | probe
  std::string device = "virtual:premium";  ///< In the form of trocar-hapticd --device.
  double rate_hz = 1000.0;
  int priority = 80;  ///< Priority of SCHED_FIFO; 0: ordinary scheduling.
  std::filesystem::path flight_folder = ".";
};

/// Extracts the error from a server's last log line ("error: what — where — what to do"); empty if it is not an error.
std::optional<Error> error_of_line(std::string_view line);

/// A haptic server started by this program, with a socket in a private folder. The destructor ends it.
class LocalServer final : public ServerHost {
 public:
  /// Returns at once; check() reports whether the process still runs. Errors: no trocar-hapticd, it cannot be started.
  static Result<std::unique_ptr<LocalServer>> start(const LocalServerOptions& options);

  const LocalServerOptions& options() const noexcept { return options_; }
  const std::string& tool() const noexcept override { return options_.tool; }
  const std::string& device() const noexcept override { return options_.device; }
  const std::string& endpoint() const noexcept override { return endpoint_; }
  int pid() const override { return process_ ? process_->pid() : 0; }
  /// Error if the process has ended: its error line, otherwise its exit status and last log line.
  Status check() override;
  bool is_held_up() override { return process_ && process_->is_held_up(); }
  /// Starts a new process on the same socket; ends the old one if it still runs.
  Status restart() override;
  Result<std::unique_ptr<ServerConnection>> connect(link::ClientOptions options) override;

 private:
  LocalServer() = default;
  LocalServerOptions options_;
  std::string endpoint_;
  std::unique_ptr<TemporaryFolder> folder_;
  std::unique_ptr<link::ServerProcess> process_;
};

/// A connection through link/client/haptic_client.h. Errors: see HapticClient::connect.
Result<std::unique_ptr<ServerConnection>> connect_by_link(const link::ClientOptions& options);

/// A haptic server that was already running: it is not supervised as a process.
class RemoteServer final : public ServerHost {
 public:
  RemoteServer(std::string endpoint, std::optional<link::ClientSecurity> security)
      : endpoint_(std::move(endpoint)), security_(std::move(security)) {}

  const std::string& tool() const noexcept override { return unknown_; }
  const std::string& device() const noexcept override { return unknown_; }
  const std::string& endpoint() const noexcept override { return endpoint_; }
  int pid() const override { return 0; }
  Status check() override { return {}; }
  bool is_held_up() override { return false; }
  Status restart() override { return fail("this program did not start the server", endpoint_, "start it again"); }
  Result<std::unique_ptr<ServerConnection>> connect(link::ClientOptions options) override {
    options.endpoint = endpoint_;
    options.security = security_;
    return connect_by_link(options);
  }

 private:
  std::string endpoint_, unknown_;
  std::optional<link::ClientSecurity> security_;
};

}  // namespace trocar::attempt
