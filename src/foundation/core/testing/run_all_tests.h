#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace trocar::testing {

/// With TROCAR_TEST_PART=2/4, only the suites of the second of four parts run. A suite stays whole, unlike with
/// GoogleTest's shards: its tests share what it prepares. The largest suites come first, each to the part with the
/// fewest tests. False: the variable's value is no part.
inline bool choose_part() {
  const char* text = std::getenv("TROCAR_TEST_PART");
  if (text == nullptr) return true;
  int part = 0, parts = 0, length = 0;
  const bool is_part = std::sscanf(text, "%d/%d%n", &part, &parts, &length) == 2 && text[length] == '\0';
  if (!is_part || part < 1 || part > parts) return false;
  const auto& all = *::testing::UnitTest::GetInstance();
  std::vector<const ::testing::TestSuite*> suites;
  for (int i = 0; i < all.total_test_suite_count(); ++i) suites.push_back(all.GetTestSuite(i));
  std::stable_sort(suites.begin(), suites.end(),
                   [](const auto* a, const auto* b) { return a->total_test_count() > b->total_test_count(); });
  std::vector<int> tests(static_cast<std::size_t>(parts), 0);
  std::string others;
  for (const ::testing::TestSuite* suite : suites) {
    const auto least = std::min_element(tests.begin(), tests.end());
    *least += suite->total_test_count();
    if (least - tests.begin() != part - 1) others += std::string(":") + suite->name() + ".*";
  }
  if (others.empty()) return true;
  std::string filter = GTEST_FLAG_GET(filter);
  if (filter.find('-') == std::string::npos) others.front() = '-';  // what follows is left out
  GTEST_FLAG_SET(filter, filter + others);
  return true;
}

/// Exit status of the test program: RUN_ALL_TESTS(), but 1 where a filter selects no test: it names one that is gone.
/// One of several parts or shards may be empty.
inline int run_all_tests() {
  if (!choose_part()) {
    std::fprintf(stderr, "error: TROCAR_TEST_PART=%s is not a part, such as 2/4\n", std::getenv("TROCAR_TEST_PART"));
    return 1;
  }
  const int status = RUN_ALL_TESTS();
  const auto& all = *::testing::UnitTest::GetInstance();
  const bool is_part = std::getenv("GTEST_TOTAL_SHARDS") != nullptr || std::getenv("TROCAR_TEST_PART") != nullptr;
  if (status == 0 && all.test_to_run_count() == 0 && !is_part && !GTEST_FLAG_GET(list_tests)) {
    std::fprintf(stderr, "error: the filter selects no test\n");
    return 1;
  }
  return status;
}

}  // namespace trocar::testing
