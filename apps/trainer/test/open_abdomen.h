#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "cases/testing/cached_case.h"

namespace trocar::trainer {

/// The case "liver biopsy" of the embedded patient, opened once for all tests of a program.
inline const std::shared_ptr<const cases::OpenCase>& open_abdomen() {
  static const std::shared_ptr<const cases::OpenCase> open = [] {
    auto result = testing::open_cached_case();
    EXPECT_TRUE(result) << result.error().text();
    if (result) (*result)->later->wait();  // views show the surfaces that are there
    return result ? *result : nullptr;
  }();
  return open;
}

}  // namespace trocar::trainer
