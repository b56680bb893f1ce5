#pragma once

#include <cstdlib>
#include <filesystem>

namespace trocar::testing {

/// Real data for tests: $TROCAR_TEST_DATA, else beside the checkout. Tests that need it skip where it is missing.
inline std::filesystem::path test_data() {
  const char* named = std::getenv("TROCAR_TEST_DATA");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(TROCAR_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace trocar::testing
