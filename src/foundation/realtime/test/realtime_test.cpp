#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "core/random.h"
#include "realtime/lock_free.h"
#include "realtime/loop_statistics.h"
#include "realtime/periodic_loop.h"

namespace trocar::realtime {
namespace {

/// Both halves always agree: a torn copy would not.
struct Pair {
  std::uint64_t a = 0, b = 0;
};

TEST(TripleBuffer, ReturnsTheNewestValueAsNewOnce) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.value(), 7);
  buffer.write(1);
  buffer.write(2);
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.value(), 2);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.newest(), 2);
}

TEST(TripleBuffer, NeverTearsOrRegressesBetweenThreads) {
  TripleBuffer<Pair> buffer;
  constexpr std::uint64_t kLast = 200'000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) buffer.write({i, ~i});
  });
  std::uint64_t last = 0;
  bool is_valid = true;
  while (last < kLast) {
    if (!buffer.update()) continue;
    const Pair pair = buffer.value();
    is_valid = is_valid && pair.b == ~pair.a && pair.a > last;
    last = std::max(last, pair.a);
  }
  writer.join();
  EXPECT_TRUE(is_valid);
}

TEST(SpscRing, KeepsOrderAndRefusesWhenFull) {
  SpscRing<int> ring(4);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  int value = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.pop(value));
}

TEST(SpscRing, LosesNothingBetweenThreads) {
  SpscRing<Pair> ring(64);
  constexpr std::uint64_t kCount = 200'000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kCount;) i += ring.push({i, ~i}) ? 1 : 0;
  });
  std::uint64_t expected = 1;
  bool is_valid = true;
  Pair pair;
  while (expected <= kCount) {
    if (!ring.pop(pair)) continue;
    is_valid = is_valid && pair.a == expected && pair.b == ~expected;
    ++expected;
  }
  writer.join();
  EXPECT_TRUE(is_valid);
}

/// Notes in its destructor that it is gone.
struct Mortal {
  explicit Mortal(int n) : number(n), check(n) {}
  ~Mortal() { check = -1; }
  int number;
  int check;
};

TEST(Handover, FreesOnlyUnusedObjects) {
  Handover<Mortal> handover;
  EXPECT_EQ(handover.acquire(), nullptr);
  auto first = std::make_shared<const Mortal>(1);
  const std::weak_ptr<const Mortal> watched = first;
  handover.publish(std::move(first));
  ASSERT_NE(handover.acquire(), nullptr);
  handover.publish(std::make_shared<const Mortal>(2));
  EXPECT_FALSE(watched.expired()) << "the user has not let go of it";
  EXPECT_EQ(handover.acquire()->number, 2);
  handover.publish(nullptr);
  EXPECT_TRUE(watched.expired() || (handover.collect(), watched.expired()));
  EXPECT_EQ(handover.acquire(), nullptr);
}

TEST(Handover, NeverReturnsAFreedObject) {
  Handover<Mortal> handover;
  std::atomic<bool> is_done{false};
  std::thread maker([&] {
    for (int i = 0; i < 20'000; ++i) handover.publish(std::make_shared<const Mortal>(i));
    is_done = true;
  });
  bool is_valid = true;
  while (!is_done) {
    if (const Mortal* mortal = handover.acquire()) is_valid = is_valid && mortal->check == mortal->number;
  }
  maker.join();
  EXPECT_TRUE(is_valid);
}

TEST(LatencyHistogram, QuantilesAreWithinThreePercent) {
  Random random(5);
  LatencyHistogram histogram;
  std::vector<std::int64_t> values;
  for (int i = 0; i < 20'000; ++i) {
    const double decade = random.uniform(0.0, 8.0);
    values.push_back(static_cast<std::int64_t>(std::pow(10.0, decade)));
    histogram.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    const auto exact = static_cast<double>(values[at]);
    EXPECT_NEAR(static_cast<double>(histogram.quantile_ns(share)), exact, 0.035 * exact + 1.0) << share;
  }
  EXPECT_EQ(histogram.max_ns(), values.back());
}

TEST(LatencyHistogram, AcceptsZeroNegativeAndHugeValues) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  histogram.add(0);
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 62);
  EXPECT_EQ(histogram.count(), 3U);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), std::int64_t{1} << 62);
}

TEST(LoopStatistics, CountsAnOverrunPeriodAsMissed) {
  LoopStatistics statistics(1000);
  statistics.add(0, 10, 500, 0);
  statistics.add(1000, 1020, 2100, 0);  // done after the next began
  statistics.add(4000, 4010, 4200, 2);  // two got no tick
  const LoopSummary summary = statistics.summary();
  EXPECT_EQ(summary.periods, 5U);
  EXPECT_EQ(summary.missed, 3U);
  EXPECT_EQ(summary.skipped, 2U);
  EXPECT_DOUBLE_EQ(summary.served(), 0.4);
  EXPECT_NEAR(summary.tick.max_us, 1.08, 1e-9);
  EXPECT_NEAR(summary.lateness.max_us, 0.02, 1e-9);
}

TEST(PeriodicLoop, KeepsItsGridAndSkipsOverrunPeriods) {
  // No timing is asserted: only that begins lie on the grid and that skipped periods are told.
  constexpr std::int64_t kPeriod_ns = 200'000;
  std::atomic<bool> is_stopping{false};
  LoopStatistics statistics(kPeriod_ns);
  std::vector<Period> periods;
  run_periodic(kPeriod_ns, is_stopping, statistics, [&](const Period& period, const LoopStatistics&) {
    periods.push_back(period);
    if (periods.size() == 10) sleep_until_ns(now_ns() + 5 * kPeriod_ns);
    if (periods.size() == 30) is_stopping = true;
  });
  ASSERT_EQ(periods.size(), 30U);
  for (std::size_t i = 1; i < periods.size(); ++i) {
    const auto steps = static_cast<std::int64_t>(periods[i].number - periods[i - 1].number);
    EXPECT_EQ(periods[i].begin_ns - periods[i - 1].begin_ns, steps * kPeriod_ns);
    EXPECT_NEAR(periods[i].dt_s, seconds(steps * kPeriod_ns), 1e-12);
  }
  EXPECT_GE(periods[10].number - periods[9].number, 5U);
  EXPECT_EQ(statistics.summary().periods, periods.back().number + 1);
}

}  // namespace
}  // namespace trocar::realtime
