#include "core/testing/run_all_tests.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

namespace trocar::testing {
namespace {

struct Listed {
  std::string text;
  int status = -1;
};

/// This program in another process: its output, and how it ended.
Listed run_self(const std::string& environment, const std::string& arguments) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string line = "env -u GTEST_FILTER " + environment + " '" + self + "' " + arguments + " 2>&1";
  Listed listed;
  std::FILE* pipe = ::popen(line.c_str(), "r");
  if (pipe == nullptr) return listed;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) listed.text += static_cast<char>(c);
  listed.status = ::pclose(pipe);
  return listed;
}

/// Lists the tests of a part.
Listed list_part(const std::string& part, const std::string& arguments = {}) {
  return run_self("TROCAR_TEST_PART=" + part, "--gtest_list_tests " + arguments);
}

/// Adds how often each suite is listed.
void count_suites(const std::string& text, std::map<std::string, int>& counts) {
  for (std::size_t begin = 0, end; begin < text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const std::string name = line.substr(0, line.find_first_of(" #"));
    if (!name.empty() && name.back() == '.') ++counts[name];
  }
}

TEST(TestParts, EverySuiteIsInOneOfThem) {
  std::map<std::string, int> counts;
  for (const char* part : {"1/3", "2/3", "3/3"}) {
    const Listed listed = list_part(part);
    ASSERT_EQ(listed.status, 0) << listed.text;
    count_suites(listed.text, counts);
  }
  const auto& all = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i)
    EXPECT_EQ(counts[std::string(all.GetTestSuite(i)->name()) + "."], 1) << all.GetTestSuite(i)->name();
}

TEST(TestParts, ApplyTheFilterWithinAPart) {
  std::map<std::string, int> counts;
  for (const char* part : {"1/2", "2/2"}) {
    count_suites(list_part(part, "--gtest_filter='TestParts.*'").text, counts);
    count_suites(list_part(part, "--gtest_filter='Test*-*Filter*'").text, counts);
  }
  EXPECT_EQ(counts["TestParts."], 2);
  EXPECT_EQ(counts.size(), 1u);
}

TEST(TestParts, RefuseAMalformedPart) {
  for (const char* part : {"0/2", "3/2", "1", "1/2x", "''", "a/b"}) EXPECT_NE(list_part(part).status, 0) << part;
}

// A filter names tests that were renamed; an empty shard of one that names some is in order.
TEST(TestFilter, OneThatSelectsNothingIsRefused) {
  const std::string shard = "GTEST_TOTAL_SHARDS=9 GTEST_SHARD_INDEX=8 ", part = "TROCAR_TEST_PART=9/9 ";
  for (const std::string& environment : {std::string(), shard, part}) {
    EXPECT_NE(run_self(environment, "--gtest_filter='NoSuch.*'").status, 0) << environment;
    EXPECT_NE(run_self(environment, "--gtest_filter='TestParts.*-TestParts.*'").status, 0) << environment;
    EXPECT_EQ(run_self(environment, "--gtest_filter='NoSuch.*:Test?arts.RefuseA*'").status, 0) << environment;
  }
}

}  // namespace
}  // namespace trocar::testing
