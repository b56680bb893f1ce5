#include "core/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace trocar {
inline namespace core {
namespace {

TEST(Error, TextStatesCausePlaceAndAdvice) {
  EXPECT_EQ(fail("is empty", "ct.nrrd", "export it again").value().text(), "is empty — ct.nrrd — export it again");
}

TEST(Error, TextLeavesOutEmptyParts) {
  EXPECT_EQ(fail("is empty").value().text(), "is empty");
  EXPECT_EQ(fail("is empty", "", "export it again").value().text(), "is empty — export it again");
  EXPECT_EQ(fail("is empty", "ct.nrrd").value().text(), "is empty — ct.nrrd");
}

TEST(Error, TextIsOneLineForAnyFileName) {
  const std::string text = fail("bad", "a\nb\r\x1b[31m\x7f.nii").value().text();
  EXPECT_EQ(text, "bad — a b  [31m .nii");
}

TEST(Error, ExitStatusDistinguishesFailureFromUsage) {
  EXPECT_EQ(fail("x").value().exit_status, 1);
  EXPECT_EQ(fail_usage("x").value().exit_status, 2);
}

Result<int> half(int n) {
  if (n % 2 != 0) return fail_usage("is odd", std::to_string(n));
  return n / 2;
}

Result<int> quarter(int n) {
  TROCAR_TRY(const int first, half(n));
  TROCAR_TRY(const int second, half(first));
  return second;
}

TEST(Try, BindsTheValueOrReturnsTheError) {
  EXPECT_EQ(quarter(12).value(), 3);
  ASSERT_FALSE(quarter(6));
  EXPECT_EQ(quarter(6).error().text(), "is odd — 3");
  EXPECT_EQ(quarter(6).error().exit_status, 2);
}

Result<std::unique_ptr<int>> make(bool works) {
  if (!works) return fail("does not work");
  return std::make_unique<int>(5);
}

TEST(Try, MovesNonCopyableValues) {
  const auto use = [](bool works) -> Result<int> {
    TROCAR_TRY(const std::unique_ptr<int> value, make(works));
    return *value;
  };
  EXPECT_EQ(use(true).value(), 5);
  EXPECT_FALSE(use(false));
}

TEST(Try, PropagatesAStatus) {
  const auto check = [](int n) -> Status {
    if (n < 0) return fail("is negative");
    return {};
  };
  const auto both = [&](int a, int b) -> Status {
    TROCAR_TRY_STATUS(check(a));
    TROCAR_TRY_STATUS(check(b));
    return {};
  };
  EXPECT_TRUE(both(1, 2));
  EXPECT_FALSE(both(-1, 2));
  EXPECT_FALSE(both(1, -2));
}

}  // namespace
}  // namespace core
}  // namespace trocar
