#include <gtest/gtest.h>

#include <thread>

#include "core/log.h"
#include "core/testing/fake_clock.h"
#include "core/text.h"

namespace trocar {
namespace {

using namespace std::chrono_literals;

TEST(LogLine, KeepsPlainText) {
  EXPECT_EQ(log_line("Größe 3 µm — \"a\"", 200), "Größe 3 µm — \"a\"");
  EXPECT_EQ(log_line("", 200), "");
}

TEST(LogLine, EscapesControlAndInvalidCharacters) {
  EXPECT_EQ(log_line("a\nb\r\x1b[2J", 200), "a\\x0ab\\x0d\\x1b[2J");
  EXPECT_EQ(log_line(std::string_view("a\0b", 3), 200), "a\\x00b");
  EXPECT_EQ(log_line("\xff\xc3(", 200), "\\xff\\xc3(");
  EXPECT_EQ(log_line("\u2028\u202e\u0085", 200), "\\xe2\\x80\\xa8\\xe2\\x80\\xae\\xc2\\x85");
}

TEST(LogLine, CutsALongTextAndStatesItsLength) {
  EXPECT_EQ(log_line("abcde", 5), "abcde");
  EXPECT_EQ(log_line("abcdef", 5), "abcde… (6 bytes)");
  EXPECT_EQ(log_line("ääääää", 5), "äääää… (12 bytes)");
  const std::string line = log_line(std::string(260'000, 'x'), LogLimit::kMostCharacters);
  EXPECT_LT(line.size(), LogLimit::kMostCharacters + 30);
  EXPECT_LE(log_line(std::string(260'000, '\n'), 200).size(), 230u) << "escapes count";
  // No cut within a character or an escape.
  for (std::size_t most = 0; most < 20; ++most) {
    const std::string cut = log_line("aä\nb€\x01", most);
    EXPECT_EQ(valid_utf8(cut), cut);
  }
}

TEST(LogLimit, PassesTenLinesThenOneEverySixSeconds) {
  testing::FakeClock clock;
  LogLimit limit(clock);
  const auto passed = [&](int lines) {
    int count = 0;
    for (int i = 0; i < lines; ++i) count += limit.pass("x") ? 1 : 0;
    return count;
  };
  EXPECT_EQ(passed(1000), 10);
  clock.advance(5999ms);
  EXPECT_EQ(passed(1000), 0);
  clock.advance(1ms);
  EXPECT_EQ(passed(1000), 1);
  clock.advance(60s);
  EXPECT_EQ(passed(1000), 10);
  clock.advance(3600s);
  EXPECT_EQ(passed(1000), 10) << "an idle hour is not saved up";
  int in_a_minute = 0;
  for (int ms = 0; ms < 60'000; ms += 10) {
    in_a_minute += passed(7);
    clock.advance(10ms);
  }
  EXPECT_EQ(in_a_minute, 9);
}

TEST(LogLimit, StatesHowManyLinesWereLeftOut) {
  testing::FakeClock clock;
  LogLimit limit(clock);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(limit.pass("x"), "x");
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(limit.pass("x"));
  clock.advance(LogLimit::kInterval);
  EXPECT_EQ(limit.pass("y"), "y (3 lines before were left out)");
  clock.advance(LogLimit::kInterval);
  EXPECT_EQ(limit.pass("y"), "y");
}

TEST(LimitedLog, LimitsTheLinesOfItsThreadOnly) {
  const auto lines_of = [](auto&& work) {
    ::testing::internal::CaptureStderr();
    work();
    const std::string text = ::testing::internal::GetCapturedStderr();
    return std::count(text.begin(), text.end(), '\n');
  };
  LogLimit limit;
  EXPECT_EQ(lines_of([&] {
              const LimitedLog limited(limit);
              for (int i = 0; i < 50; ++i) log_info("below the level: it uses nothing up");
              for (int i = 0; i < 50; ++i) log_warning("a\nb {}", i);
            }),
            10);
  EXPECT_EQ(lines_of([&] {
              for (int i = 0; i < 20; ++i) log_warning("no limit");
            }),
            20);
  EXPECT_EQ(lines_of([&] {
              const LimitedLog limited(limit);
              std::thread([] { log_warning("another thread"); }).join();
            }),
            1);
}

}  // namespace
}  // namespace trocar
