#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::link::detail {

struct Program {
  std::filesystem::path path;
  std::vector<std::string> arguments;
  std::filesystem::path log;  ///< Standard output and error are added to it; empty: ours.
};

/// Starts a child that the kernel ends (SIGTERM) when the calling thread ends; gives its process id. Errors: the log
/// cannot be written, the program cannot be run.
Result<int> start_program(const Program& program);

}  // namespace trocar::link::detail
