#include "dicom/stack/slice_stack.h"

#include <gtest/gtest.h>

#include <numeric>

namespace trocar::dicom {
namespace {

SliceStack stack_at(const std::vector<double>& z_mm, double lean = 0.0) {
  SliceStack stack;
  stack.columns = 3;
  stack.rows = 4;
  for (const double z : z_mm) stack.origins_P.emplace_back(1.0, 2.0 + lean * z, z);
  return stack;
}

template <class T>
std::vector<T> pixels_by_slice(const SliceStack& stack, const std::vector<T>& values) {
  std::vector<T> pixels;
  for (const T value : values) pixels.insert(pixels.end(), static_cast<std::size_t>(stack.columns * stack.rows), value);
  return pixels;
}

TEST(SliceStack, KeepsEvenSlicesUnchanged) {
  const SliceStack stack = stack_at({0, 2, 4});
  const StackPlan plan = plan_stack(stack).value();
  EXPECT_TRUE(plan.is_plain);
  std::vector<std::int16_t> pixels(36);
  std::iota(pixels.begin(), pixels.end(), 0);
  EXPECT_EQ(fill_from_stack<std::int16_t>(plan, stack, pixels, -1).voxels, pixels);
}

TEST(SliceStack, UnevenNumbersAreInterpolatedAndLabelsAreNot) {
  const SliceStack stack = stack_at({0, 2, 6, 8});
  const StackPlan plan = plan_stack(stack).value();
  ASSERT_EQ(plan.geometry.size[2], 5);
  const auto numbers =
      fill_from_stack<std::int16_t>(plan, stack, pixels_by_slice<std::int16_t>(stack, {0, 20, 60, 80}), -1);
  const auto labels = fill_from_stack<std::uint8_t>(plan, stack, pixels_by_slice<std::uint8_t>(stack, {1, 2, 3, 4}), 9);
  for (std::int64_t k = 0; k < 5; ++k) EXPECT_EQ((numbers[{1, 1, k}]), 20 * k);
  EXPECT_EQ((labels[{1, 1, 1}]), 2);
  EXPECT_TRUE((labels[{1, 1, 2}] == 2 || labels[{1, 1, 2}] == 3));
  EXPECT_EQ((labels[{1, 1, 3}]), 3);
}

TEST(SliceStack, ShiftsTiltedSlices) {
  const SliceStack stack = stack_at({0, 2, 4}, -0.5);  // one row to the front for each slice
  const StackPlan plan = plan_stack(stack).value();
  ASSERT_FALSE(plan.is_plain);
  EXPECT_EQ(plan.geometry.size, (std::array<std::int64_t, 3>{3, 6, 3}));
  EXPECT_LT((plan.geometry.origin_P - Vec3(1, 0, 0)).norm(), 1e-12);
  const auto labels = fill_from_stack<std::uint8_t>(plan, stack, pixels_by_slice<std::uint8_t>(stack, {1, 2, 3}), 9);
  for (std::int64_t k = 0; k < 3; ++k)
    for (std::int64_t j = 0; j < 6; ++j) EXPECT_EQ((labels[{1, j, k}]), j >= 2 - k && j < 6 - k ? k + 1 : 9) << j << k;
}

TEST(SliceStack, HasNoPlanForAbsurdPositions) {
  EXPECT_FALSE(plan_stack(stack_at({0, 2, 4, 5000})));
  EXPECT_FALSE(plan_stack(stack_at({0, 2, 4}, 1.5)));
  EXPECT_TRUE(is_sane(stack_at({0, 2, 4})));
  EXPECT_FALSE(is_sane(stack_at({0, 2, 1e6})));
  SliceStack stack = stack_at({0, 2});
  stack.row_step_mm = 1e-40;
  EXPECT_FALSE(is_sane(stack));
}

TEST(SliceStack, NamesTheSliceAtTheWidestGap) {
  const StackGap gap = widest_gap(stack_at({0, 2, 4, 9, 11}));
  EXPECT_EQ(gap.below, 2U);
  EXPECT_NEAR(gap.gap_mm, 5.0, 1e-12);
  EXPECT_NEAR(gap.median_mm, 2.0, 1e-12);
}

}  // namespace
}  // namespace trocar::dicom
