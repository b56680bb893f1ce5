#include "core/live/feed.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <vector>

#include "core/start_thread.h"

namespace trocar {
namespace {

TEST(Feed, HandsTheNewestValueToAnyNumberOfReaders) {
  Feed<int> feed;
  EXPECT_EQ(feed.newest().number, 0U);
  EXPECT_EQ(feed.value(), nullptr);
  feed.publish(7);
  feed.publish(8);
  const Feed<int>::Item first = feed.newest(), second = feed.newest();
  EXPECT_EQ(*first.value, 8);
  EXPECT_EQ(first.value, second.value) << "no copy";
  EXPECT_EQ(first.number, 2U) << "the reader sees that it has missed one";
}

TEST(Feed, KeepsAValueAsLongAsAReaderHasIt) {
  Feed<int> feed;
  const auto value = std::make_shared<const int>(1);
  feed.publish(value);
  const std::weak_ptr<const int> watched = value;
  const auto held = feed.value();
  feed.clear();
  EXPECT_EQ(feed.value(), nullptr);
  EXPECT_EQ(feed.newest().number, 2U) << "a withdrawn value is news, too";
  EXPECT_EQ(*held, 1);
}

/// Both halves of a value have to belong together, and numbers never go back.
TEST(Feed, IsConsistentForReadersOnOtherThreads) {
  using Pair = std::array<int, 2>;
  constexpr int kValues = 20'000;
  Feed<Pair> feed;
  std::atomic<int> faults{0};
  std::vector<std::thread> readers;
  for (int n = 0; n < 3; ++n)
    readers.push_back(start_thread("reader", [&] {
                        for (std::uint64_t last = 0; last < kValues;) {
                          const Feed<Pair>::Item item = feed.newest();
                          const bool is_whole = item.value == nullptr || (*item.value)[1] == -(*item.value)[0];
                          const bool is_own =
                              item.value == nullptr || static_cast<std::uint64_t>((*item.value)[0]) == item.number;
                          faults += is_whole && is_own && item.number >= last ? 0 : 1;
                          last = item.number;
                        }
                      }).value());
  for (int n = 1; n <= kValues; ++n) feed.publish(Pair{n, -n});
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(faults, 0);
}

}  // namespace
}  // namespace trocar
