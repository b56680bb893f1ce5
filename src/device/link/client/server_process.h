#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::link {

/// A trocar-hapticd that this process started. The destructor ends it (SIGTERM, then SIGKILL after 2 s); the kernel
/// ends it if this process is killed.
class ServerProcess {
 public:
  /// Starts `program` with `arguments` and returns at once; standard output and error go to `log`; if `log` is
  /// empty, to those of this process.
  static Result<ServerProcess> start(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& log = {});
  ServerProcess(ServerProcess&&) noexcept;
  ServerProcess& operator=(ServerProcess&&) noexcept;
  ~ServerProcess();

  int pid() const;
  bool is_running();
  /// True if the process cannot respond now: it is stopped, or one of its threads is running or waiting for a processor
  /// or a disk. False if all threads sleep, and after its end.
  bool is_held_up();
  /// Text like "ended with exit status 1" or "was killed by signal 9"; empty while it runs.
  std::string how_it_ended();
  void stop();

 private:
  struct Impl;
  explicit ServerProcess(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Path of trocar-hapticd next to the running program, else on PATH. Error: not found.
Result<std::filesystem::path> find_server_program();

}  // namespace trocar::link
