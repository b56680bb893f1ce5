#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/temporary_folder.h"
#include "link/client/server_process.h"

namespace trocar::attempt {

/// How a trocar-hapticd of our own is started.
struct OwnServerOptions {
  std::string tool = "needle";             ///< needle | probe
  std::string device = "virtual:premium";  ///< As trocar-hapticd --device takes it.
  double rate_hz = 1000.0;
  int priority = 80;  ///< Of SCHED_FIFO; 0: ordinary scheduling.
  std::filesystem::path flight_folder = ".";
};

/// Extracts the error from a server's last log line ("error: what — where — what to do"); empty if it is not an error.
std::optional<Error> error_of_line(std::string_view line);

/// A haptic server started by this program, with a socket in a private folder. The destructor ends it.
class OwnServer {
 public:
  /// Returns at once; whether it comes up, check() tells. Errors: no trocar-hapticd, it cannot be started.
  static Result<OwnServer> start(const OwnServerOptions& options);

  const OwnServerOptions& options() const noexcept { return options_; }
  const std::string& endpoint() const noexcept { return endpoint_; }
  int pid() const { return process_->pid(); }
  /// Error if the process has ended: its error line, otherwise its exit status and last log line.
  Status check();
  /// See ServerProcess.
  bool is_held_up() { return process_ && process_->is_held_up(); }
  /// A new process on the same socket; ends the old one where it still runs.
  Status restart();

 private:
  OwnServer() = default;
  OwnServerOptions options_;
  std::string endpoint_;
  std::unique_ptr<TemporaryFolder> folder_;
  std::unique_ptr<link::ServerProcess> process_;
};

}  // namespace trocar::attempt
