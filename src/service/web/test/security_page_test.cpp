// docs/security.md names every requirement of OWASP ASVS 5.0 level 1 once, and only tests that exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "core/testing/source_dir.h"

namespace trocar::web {
namespace {
namespace fs = std::filesystem;

/// Level 1 of version 5.0.0, by section: OWASP/ASVS, 5.0/docs_en.
const std::map<std::string, std::vector<int>> kLevel1 = {
    {"1.2", {1, 2, 3, 4, 5}},
    {"1.3", {1, 2}},
    {"1.5", {1}},
    {"2.1", {1}},
    {"2.2", {1, 2}},
    {"2.3", {1}},
    {"3.2", {1, 2}},
    {"3.3", {1}},
    {"3.4", {1, 2}},
    {"3.5", {1, 2, 3}},
    {"4.1", {1}},
    {"4.4", {1}},
    {"5.2", {1, 2}},
    {"5.3", {1, 2}},
    {"6.1", {1}},
    {"6.2", {1, 2, 3, 4, 5, 6, 7, 8}},
    {"6.3", {1, 2}},
    {"6.4", {1, 2}},
    {"7.2", {1, 2, 3, 4}},
    {"7.4", {1, 2}},
    {"8.1", {1}},
    {"8.2", {1, 2}},
    {"8.3", {1}},
    {"9.1", {1, 2, 3}},
    {"9.2", {1}},
    {"10.4", {1, 2, 3, 4, 5}},
    {"11.3", {1, 2}},
    {"11.4", {1}},
    {"12.1", {1}},
    {"12.2", {1, 2}},
    {"13.4", {1}},
    {"14.2", {1}},
    {"14.3", {1}},
    {"15.1", {1}},
    {"15.2", {1}},
    {"15.3", {1}},
};
constexpr std::size_t kRequirements = 70;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::set<std::string> tests_in(const std::string& folder) {
  static const std::regex macro(R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> tests;
  for (const auto& entry : fs::directory_iterator(trocar::testing::source_dir() / folder)) {
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), macro), end; match != end; ++match)
      tests.insert(match->str(1) + "." + match->str(2));
  }
  return tests;
}

TEST(SecurityPage, HasEveryRequirementOfLevel1Once) {
  std::multiset<std::string> listed;
  std::istringstream page(text_of(trocar::testing::source_dir() / "docs/security.md"));
  static const std::regex row(R"(^\| (\d+\.\d+\.\d+) \| .+ \| .+ \|$)");
  std::smatch match;
  for (std::string line; std::getline(page, line);)
    if (std::regex_match(line, match, row)) listed.insert(match.str(1));
  EXPECT_EQ(listed.size(), kRequirements);
  for (const auto& [section, numbers] : kLevel1)
    for (const int number : numbers)
      EXPECT_EQ(listed.count(section + "." + std::to_string(number)), 1U) << section << "." << number;
}

TEST(SecurityPage, NamesOnlyTestsAndFilesThatExist) {
  std::set<std::string> tests = tests_in("src/service/web/test");
  tests.merge(tests_in("src/foundation/signing/test"));
  tests.merge(tests_in("src/exchange/dicom/pacs/test"));
  const std::string page = text_of(trocar::testing::source_dir() / "docs/security.md");
  static const std::regex test(R"(`([A-Z]\w+\.[A-Z]\w+)`)"), file(R"(`((?:web|tests|apps)/[\w/.]+\.\w+)`)");
  std::size_t named = 0;
  for (std::sregex_iterator match(page.begin(), page.end(), test), end; match != end; ++match, ++named)
    EXPECT_TRUE(tests.contains(match->str(1))) << match->str(1);
  EXPECT_GT(named, 50U);
  for (std::sregex_iterator match(page.begin(), page.end(), file), end; match != end; ++match)
    EXPECT_TRUE(fs::exists(trocar::testing::source_dir() / match->str(1))) << match->str(1);
}

}  // namespace
}  // namespace trocar::web
