#include "anatomy/hu_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "anatomy/hu_transfer_text.h"
#include "core/data_dir.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/allocation_guard.inc.h"

namespace trocar {
namespace {

HuTransfer make_transfer() {
  HuTransfer transfer;
  transfer.knot_count = 3;
  transfer.hu = {-100.0, 0.0, 50.0};
  transfer.laws[0] = {1.0, 2.0, 3.0, 4.0, 0.5, 0.06, 0.7, 8.0};
  transfer.laws[1] = {3.0, 4.0, 5.0, 8.0, 0.1, 0.02, 0.3, 0.0};
  transfer.laws[2] = {5.0, 0.0, 1.0, 2.0, 0.3, 0.04, 0.5, 80.0};
  return transfer;
}

void expect_law(const HuLaw& law, const HuLaw& expected) {
  for (const auto& field : kHuLawFields) EXPECT_DOUBLE_EQ(law.*field.member, expected.*field.member) << field.name;
}

TEST(HuTransfer, GivesTheKnotsLawsAtTheKnots) {
  const HuTransfer transfer = make_transfer();
  for (std::size_t n = 0; n < transfer.knot_count; ++n) expect_law(transfer.at(transfer.hu[n]), transfer.laws[n]);
}

TEST(HuTransfer, IsLinearBetweenKnots) {
  const HuTransfer transfer = make_transfer();
  expect_law(transfer.at(-50.0), {2.0, 3.0, 4.0, 6.0, 0.3, 0.04, 0.5, 4.0});
  expect_law(transfer.at(12.5), {3.5, 3.0, 4.0, 6.5, 0.15, 0.025, 0.35, 20.0});
}

TEST(HuTransfer, IsConstantBeyondTheOutermostKnotsAndForNaN) {
  const HuTransfer transfer = make_transfer();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double hu : {-100.001, -1e300, -kInf, std::nan("")}) expect_law(transfer.at(hu), transfer.laws[0]);
  for (const double hu : {50.001, 1e300, kInf}) expect_law(transfer.at(hu), transfer.laws[2]);
  expect_law(HuTransfer{}.at(40.0), HuLaw{});
}

TEST(HuTransfer, DoesNotAllocate) {
  const HuTransfer transfer = make_transfer();
  double sum = 0.0;
  const testing::AllocationGuard guard;
  for (int hu = -1024; hu < 3072; ++hu) sum += transfer.at(hu).normal_n;
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace trocar
