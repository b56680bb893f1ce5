#pragma once

#include <cstdint>

#include "core/live/live_schedule.h"

namespace trocar::testing {

enum class TestLevel { kCoarse, kMiddle, kFine };

/// Requests are compared by `place`; the work of the levels is 1, 2 and 4.
struct TestTraits {
  struct Request {
    int place = 0;
  };
  struct Image {
    int place = 0;
    TestLevel level = TestLevel::kCoarse;
    std::uint64_t number = 0;
    double took_ms = 0.0;
  };
  using Level = TestLevel;
  static constexpr std::size_t kLevels = 3;

  LivePace pace() const { return {.moving_ms = 50.0, .still_s = 0.3, .busy_share = 0.5}; }
  bool is_same(const Request& a, const Request& b) const { return a.place == b.place; }
  double work(const Request&, Level level) const { return static_cast<double>(1 << static_cast<int>(level)); }
  double refresh_s(const Request&) const { return 0.1; }
  static void stamp(Image& image, std::uint64_t number, double took_ms) {
    image.number = number;
    image.took_ms = took_ms;
  }
};

}  // namespace trocar::testing
