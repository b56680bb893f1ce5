#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "attempt/servers/server_host.h"
#include "core/files/temporary_folder.h"
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

}  // namespace trocar::attempt
