#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::bench {

/// Real data for benchmarks: $TROCAR_TEST_DATA, else beside the checkout. May not exist.
std::filesystem::path real_data();

/// Runs a program of the PATH without its output and waits for it. Error: it could not be started, or failed.
Status run_quietly(const std::vector<std::string>& arguments);

}  // namespace trocar::bench
