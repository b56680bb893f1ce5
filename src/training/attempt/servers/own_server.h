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

/// The error that a server's last line says, as a program ends with one ("error: what — where — what to do"); none:
/// the line is no error.
std::optional<Error> error_of_line(std::string_view line);

/// A haptic server of our own, on a socket in a folder of its own. Ends with this.
class OwnServer {
 public:
  /// Returns at once; whether it comes up, check() tells. Errors: no trocar-hapticd, it cannot be started.
  static Result<OwnServer> start(const OwnServerOptions& options);

  const OwnServerOptions& options() const noexcept { return options_; }
  const std::string& endpoint() const noexcept { return endpoint_; }
  int pid() const { return process_->pid(); }
  /// Error: it has ended; what it said was wrong, else how it ended and the last line of its log.
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
