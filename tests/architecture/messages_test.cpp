// Every error message says what went wrong, where, and what to do.
#include "architecture/messages.h"

#include <gtest/gtest.h>

#include "architecture/source_files.h"

namespace trocar::architecture {
namespace {

std::size_t complaints_of(std::string_view source) {
  return check_messages("src/exchange/io/a.cpp", source).size();
}

TEST(Messages, NeedAllThreeParts) {
  EXPECT_EQ(complaints_of("return fail(\"what\", path.string(), \"do this\");"), 0u);
  EXPECT_EQ(complaints_of("return fail(\"what\");"), 1u);
  EXPECT_EQ(complaints_of("return fail(\"what\", where);"), 1u);
  EXPECT_EQ(complaints_of("return fail(\"what\", where, \"\");"), 1u);
  EXPECT_EQ(complaints_of("return fail_usage(\"what\", where, {});"), 1u);
  EXPECT_EQ(complaints_of("return fail_usage(\"what\", {}, advice);"), 0u);
}

TEST(Messages, BracketsAndStringsHideCommas) {
  EXPECT_EQ(complaints_of("return fail(fmt::format(\"{}, {}\", a, b), where(x, y));"), 1u);
  EXPECT_EQ(complaints_of("return fail(\"a, b, \\\", c\", where);"), 1u);
  EXPECT_EQ(complaints_of("return fail(text(','), std::array{1, 2}[0],\n    advice(a, b));"), 0u);
}

TEST(Messages, OtherCallsMayHaveFewerParts) {
  EXPECT_EQ(complaints_of("log_fail(\"what\"); is_fail(x); fail_unknown(x);"), 0u);
  EXPECT_EQ(complaints_of("tl::unexpected<Error> fail(std::string what, std::string where = {});"), 0u);
}

TEST(Messages, AreReportedWithTheirLines) {
  const auto complaints = check_messages("src/exchange/io/a.cpp", "\n\n  return fail(\"what\");\n");
  ASSERT_EQ(complaints.size(), 1u);
  EXPECT_TRUE(complaints.front().starts_with("src/exchange/io/a.cpp:3: ")) << complaints.front();
}

TEST(Messages, OfTheWholeProgramGiveAdvice) {
  std::size_t calls = 0;
  for (const auto& [path, text] : source_files({"src", "apps", "bench", "lab"})) {
    if (path.find("/test/") != std::string::npos) continue;
    calls += find_fail_calls(text).size();
    for (const std::string& complaint : check_messages(path, text)) ADD_FAILURE() << complaint;
  }
  EXPECT_GT(calls, 400u);
}

}  // namespace
}  // namespace trocar::architecture
