#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "anatomy/tissue/tissue_fields.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/allocation_guard.inc.h"

namespace trocar::anatomy {
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

TEST(HuTransfer, MatchesTheKnotsAtTheKnots) {
  const HuTransfer transfer = make_transfer();
  for (std::size_t n = 0; n < transfer.knot_count; ++n) expect_law(transfer.at(transfer.hu[n]), transfer.laws[n]);
}

TEST(HuTransfer, IsLinearBetweenKnots) {
  const HuTransfer transfer = make_transfer();
  expect_law(transfer.at(-50.0), {2.0, 3.0, 4.0, 6.0, 0.3, 0.04, 0.5, 4.0});
  expect_law(transfer.at(12.5), {3.5, 3.0, 4.0, 6.5, 0.15, 0.025, 0.35, 20.0});
}

TEST(HuTransfer, IsConstantBeyondTheKnotsAndForNaN) {
  const HuTransfer transfer = make_transfer();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double hu : {-100.001, -1e300, -kInf, std::nan("")}) expect_law(transfer.at(hu), transfer.laws[0]);
  for (const double hu : {50.001, 1e300, kInf}) expect_law(transfer.at(hu), transfer.laws[2]);
  expect_law(HuTransfer{}.at(40.0), HuLaw{});
}

/// Greatest force of the tip across an ideal border as a CT shows it: a step blurred to `fwhm_mm`, and the gradient by
/// central differences (docs/physics.md, B5).
double border_peak_n(const HuTransfer& transfer, double from_hu, double to_hu, double fwhm_mm) {
  const double sigma_mm = fwhm_mm / (2.0 * std::sqrt(2.0 * std::log(2.0)));
  const auto hu_at = [&](double x) {
    return from_hu + (to_hu - from_hu) * 0.5 * std::erfc(-x / (sigma_mm * std::sqrt(2.0)));
  };
  double peak_n = 0.0;
  for (double x = -8.0; x <= 8.0; x += 0.01) {
    const double h = transfer.gradient_scale_mm;
    const double slope = (hu_at(x + h) - hu_at(x - h)) / (2.0 * h);
    const double t = std::clamp((slope - transfer.gradient_none_hu_per_mm) /
                                    (transfer.gradient_full_hu_per_mm - transfer.gradient_none_hu_per_mm),
                                0.0, 1.0);
    peak_n = std::max(peak_n, t * t * (3.0 - 2.0 * t) * transfer.at(hu_at(x)).normal_n);
  }
  return peak_n;
}

TEST(HuTransfer, ShippedBordersMatchTheTissueBehindThem) {
  const auto table = load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(table) << table.error().text();
  const double muscle_n = table->layers[*table->find_layer("muscle")].puncture_force_n;
  constexpr double kStrongestDevice_n = 37.5;
  for (const double fwhm_mm : {1.5, 2.0, 2.5}) {
    const auto peak_n = [&](double from, double to) { return border_peak_n(table->transfer, from, to, fwhm_mm); };
    EXPECT_NEAR(peak_n(-105.0, 55.0), muscle_n, 0.05 * muscle_n) << "fat, muscle " << fwhm_mm;
    EXPECT_LT(peak_n(-105.0, 8.0), 0.25 * muscle_n) << "fat, fluid " << fwhm_mm;
    EXPECT_EQ(peak_n(105.0, 170.0), 0.0) << "liver, enhanced vessel " << fwhm_mm;
    EXPECT_LT(peak_n(-105.0, 170.0), 1.1 * muscle_n) << "fat, enhanced vessel " << fwhm_mm;
    EXPECT_GT(peak_n(-105.0, 700.0), kStrongestDevice_n) << "fat, bone " << fwhm_mm;
    EXPECT_EQ(peak_n(55.0, -105.0), 0.0) << "out of muscle into fat " << fwhm_mm;
  }
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
}  // namespace trocar::anatomy
