#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::bench {

/// Folder of real data for benchmarks: $TROCAR_TEST_DATA, else a folder beside the checkout. It may not exist.
std::filesystem::path real_data();

/// Runs a program of the PATH, discards its output and waits for it. Errors: it could not be started, or it failed.
Status run_quietly(const std::vector<std::string>& arguments);
/// The same for `trocar ARGUMENTS`, the program beside this one.
Status run_trocar(std::vector<std::string> arguments);

}  // namespace trocar::bench
