#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "cases/open_case.h"

namespace trocar::trainer {

/// The embedded patient's liver biopsy, opened once for all tests; kept beside the build for the next time, as the
/// program keeps it.
inline const std::shared_ptr<const cases::OpenCase>& open_abdomen() {
  static const std::shared_ptr<const cases::OpenCase> open = [] {
    cases::OpenOptions options;
    if (const char* programs = std::getenv("TROCAR_BIN_DIR"))
      options.cache_folder = std::filesystem::path(programs).parent_path() / "test-cache/trocar/patients";
    auto result = cases::make_open_case({}, options);
    EXPECT_TRUE(result) << result.error().text();
    return result ? *result : nullptr;
  }();
  return open;
}

}  // namespace trocar::trainer
