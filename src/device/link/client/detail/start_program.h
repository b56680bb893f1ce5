#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::link::detail {

struct Program {
  std::filesystem::path path;
  std::vector<std::string> arguments;
  std::filesystem::path log;  ///< Standard output and error are appended to it; empty: those of this process.
};

/// Starts a child process and returns its process id. The kernel ends the child (SIGTERM) when the calling thread ends.
/// Errors: the log cannot be written, the program cannot be run.
Result<int> start_program(const Program& program);

}  // namespace trocar::link::detail
