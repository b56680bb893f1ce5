#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "station/open_case.h"

namespace trocar::trainer {

/// The embedded patient's liver biopsy, opened once for all tests.
inline const std::shared_ptr<const OpenCase>& open_abdomen() {
  static const std::shared_ptr<const OpenCase> open = [] {
    auto result = make_open_case({});
    EXPECT_TRUE(result) << result.error().text();
    return result ? *result : nullptr;
  }();
  return open;
}

}  // namespace trocar::trainer
