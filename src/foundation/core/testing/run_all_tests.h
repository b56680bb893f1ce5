#pragma once

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
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

/// Whether one of GoogleTest's patterns, separated by ":", fits the name.
inline bool fits_pattern(const std::string& patterns, const std::string& name) {
  std::istringstream all(patterns);
  for (std::string pattern; std::getline(all, pattern, ':');)
    if (fnmatch(pattern.c_str(), name.c_str(), FNM_NOESCAPE) == 0) return true;
  return false;
}

/// Whether the filter names a test that exists, whatever part or shard of them runs; what follows its "-" is left out.
inline bool filter_selects_a_test() {
  const std::string filter = GTEST_FLAG_GET(filter);
  const std::size_t minus = std::min(filter.find('-'), filter.size());
  const std::string wanted = minus == 0 ? "*" : filter.substr(0, minus);
  const std::string left_out = filter.substr(std::min(minus + 1, filter.size()));
  const auto& all = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i)
    for (int j = 0; j < all.GetTestSuite(i)->total_test_count(); ++j) {
      const ::testing::TestInfo& test = *all.GetTestSuite(i)->GetTestInfo(j);
      const std::string name = std::string(test.test_suite_name()) + "." + test.name();
      if (fits_pattern(wanted, name) && !fits_pattern(left_out, name)) return true;
    }
  return false;
}

/// Exit status of the test program: RUN_ALL_TESTS(), but 1 where the filter selects no test: it names one that is gone.
/// One of several parts or shards may be empty.
inline int run_all_tests() {
  if (!filter_selects_a_test() && !GTEST_FLAG_GET(list_tests)) {
    std::fprintf(stderr, "error: the filter selects no test\n");
    return 1;
  }
  if (!choose_part()) {
    std::fprintf(stderr, "error: TROCAR_TEST_PART=%s is not a part, such as 2/4\n", std::getenv("TROCAR_TEST_PART"));
    return 1;
  }
  return RUN_ALL_TESTS();
}

}  // namespace trocar::testing
