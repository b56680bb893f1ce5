#include "core/available_memory.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace trocar {
inline namespace core {
namespace {

TEST(AvailableMemory, ReturnsFreedMemoryToTheSystem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers' allocator keeps freed memory";
#endif
  constexpr std::size_t kBlock_bytes = 100'000;  // below the size that the allocator maps one by one
  constexpr std::size_t kBlocks = 2000;
  std::vector<std::unique_ptr<std::vector<char>>> blocks;
  for (std::size_t n = 0; n < kBlocks; ++n) blocks.push_back(std::make_unique<std::vector<char>>(kBlock_bytes, 'x'));
  const auto last = std::make_unique<std::vector<char>>(kBlock_bytes, 'x');  // above all others: nothing shrinks
  const std::uint64_t full = resident_memory_bytes();
  ASSERT_GT(full, kBlocks * kBlock_bytes);
  blocks.clear();
  release_freed_memory();
  EXPECT_LT(resident_memory_bytes(), full - kBlocks * kBlock_bytes / 2);
  EXPECT_EQ(last->front(), 'x');
}

}  // namespace
}  // namespace core
}  // namespace trocar
