#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace trocar::testing {

/// Exit status of the test program: RUN_ALL_TESTS(), but 1 where a filter selects no test: it names one that is gone.
/// With several shards, one of them may be empty.
inline int run_all_tests() {
  const int status = RUN_ALL_TESTS();
  const auto& all = *::testing::UnitTest::GetInstance();
  const bool is_shard = std::getenv("GTEST_TOTAL_SHARDS") != nullptr;
  if (status == 0 && all.test_to_run_count() == 0 && !is_shard && !GTEST_FLAG_GET(list_tests)) {
    std::fprintf(stderr, "error: the filter selects no test\n");
    return 1;
  }
  return status;
}

}  // namespace trocar::testing
