#pragma once

#include <cstdlib>
#include <filesystem>

#include "core/testing/source_dir.h"

namespace trocar::testing {

/// Folder of real data for tests: $TROCAR_TEST_DATA, else a folder beside the checkout. Tests that need it skip if it
/// is missing.
inline std::filesystem::path test_data() {
  const char* named = std::getenv("TROCAR_TEST_DATA");
  return named != nullptr ? std::filesystem::path(named) : source_dir() / ".." / "shared" / "data";
}

}  // namespace trocar::testing
