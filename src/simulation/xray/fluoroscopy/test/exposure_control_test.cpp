#include "xray/fluoroscopy/exposure_control.h"

#include <gtest/gtest.h>

namespace trocar::xray {
namespace {

MassImage body(double g_per_cm2) {
  MassImage masses;
  masses.columns = masses.rows = 32;
  masses.of(Basis::kWater).assign(masses.size(), static_cast<float>(g_per_cm2));
  return masses;
}

/// Air kerma at the detector (nGy) behind the body.
double detector_ngy(const Exposure& exposure, double g_per_cm2, const CArm& arm) {
  const Beam beam = Beam::make(tube_spectrum(exposure.tube).value()).value();
  return 1e6 * exposure.mas * at_distance(beam.air_kerma_mgy(), arm.source_detector_mm) *
         beam.signal({g_per_cm2, 0.0, 0.0, 0.0});
}

double reference_mgy_per_min(const Exposure& exposure, double pulses_per_s, const CArm& arm) {
  const Beam beam = Beam::make(tube_spectrum(exposure.tube).value()).value();
  return 60.0 * pulses_per_s * exposure.mas * at_distance(beam.air_kerma_mgy(), reference_distance_mm(arm));
}

TEST(ExposureControl, HoldsTheDetectorsDoseForAllBodies) {
  const CArm arm;
  const ExposureLimits limits;
  BeamCache beams;
  double former_kv = 0.0;
  for (const double mass : {5.0, 10.0, 15.0, 20.0}) {
    const Exposure exposure = control_exposure(body(mass), arm, Tube{}, DoseMode::kNormal, 15.0, limits, beams).value();
    EXPECT_FALSE(exposure.is_limited) << mass;
    EXPECT_NEAR(detector_ngy(exposure, mass, arm), limits.detector_ngy, 0.01 * limits.detector_ngy) << mass;
    EXPECT_GE(exposure.tube.kv, former_kv) << "thicker bodies need a higher voltage";
    former_kv = exposure.tube.kv;
  }
  EXPECT_GT(former_kv, 80.0);
}

/// A slab over the first `columns` of 32 columns, and air beside it.
MassImage slab_over(double g_per_cm2, int columns) {
  MassImage masses = body(g_per_cm2);
  std::vector<float>& water = masses.of(Basis::kWater);
  for (std::size_t n = 0; n < water.size(); ++n)
    if (static_cast<int>(n % 32) >= columns) water[n] = 0.0F;
  return masses;
}

/// The mean of equal rays depends on their number by rounding alone.
void expect_same(const Exposure& a, const Exposure& b) {
  EXPECT_EQ(a.tube, b.tube);
  EXPECT_NEAR(a.mas, b.mas, 1e-9 * b.mas);
  EXPECT_EQ(a.is_limited, b.is_limited);
}

TEST(ExposureControl, DoesNotMeasureDirectRadiation) {
  const CArm arm;
  BeamCache beams;
  for (const double mass : {1.0, 5.0, 15.0, 25.0}) {
    const auto exposure_of = [&](int columns) {
      return control_exposure(slab_over(mass, columns), arm, Tube{}, DoseMode::kNormal, 15.0, {}, beams).value();
    };
    const Exposure whole = exposure_of(32);
    for (const int columns : {24, 16, 11}) expect_same(exposure_of(columns), whole);
    // The measuring field begins at column 8: the slab is beside it.
    EXPECT_EQ(exposure_of(8), exposure_of(0)) << mass;
  }
}

TEST(ExposureControl, DoesNotMeasureTheEdgeOfTheBody) {
  const CArm arm;
  BeamCache beams;
  MassImage masses = slab_over(20.0, 16);
  for (std::size_t n = 0; n < masses.size(); ++n)
    if (n % 32 >= 16 && n % 32 < 20) masses.of(Basis::kWater)[n] = 1.5F;
  expect_same(control_exposure(masses, arm, Tube{}, DoseMode::kNormal, 15.0, {}, beams).value(),
              control_exposure(body(20.0), arm, Tube{}, DoseMode::kNormal, 15.0, {}, beams).value());
}

TEST(ExposureControl, FollowsTheDoseMode) {
  const CArm arm;
  BeamCache beams;
  const auto mas = [&](DoseMode mode) {
    return control_exposure(body(15.0), arm, Tube{}, mode, 7.5, {}, beams).value().mas;
  };
  EXPECT_NEAR(mas(DoseMode::kLow) / mas(DoseMode::kNormal), 0.5, 1e-9);
  EXPECT_NEAR(mas(DoseMode::kHigh) / mas(DoseMode::kNormal), 2.0, 1e-9);
}

TEST(ExposureControl, RaisesTheDoseForSmallFieldsAndAcquisitions) {
  CArm arm;
  const ExposureLimits limits;
  BeamCache beams;
  const auto dose = [&](DoseMode mode) {
    return detector_ngy(control_exposure(body(15.0), arm, Tube{}, mode, 7.5, limits, beams).value(), 15.0, arm);
  };
  EXPECT_NEAR(dose(DoseMode::kAcquisition), limits.acquisition_ngy, 0.01 * limits.acquisition_ngy);
  arm.field_mm = 150.0;
  EXPECT_NEAR(dose(DoseMode::kNormal), 2.0 * limits.detector_ngy, 0.02 * limits.detector_ngy);
}

TEST(ExposureControl, StaysWithinItsLimits) {
  const CArm arm;
  const ExposureLimits limits;
  BeamCache beams;
  const Exposure exposure = control_exposure(body(60.0), arm, Tube{}, DoseMode::kHigh, 30.0, limits, beams).value();
  EXPECT_TRUE(exposure.is_limited);
  EXPECT_EQ(exposure.tube.kv, limits.most_kv);
  EXPECT_LE(exposure.mas, limits.most_mas);
  EXPECT_LE(reference_mgy_per_min(exposure, 30.0, arm), 1.001 * limits.most_mgy_per_min);
  EXPECT_LT(detector_ngy(exposure, 60.0, arm), 2.0 * limits.detector_ngy);
}

TEST(ExposureControl, NamesAnImpossibleTube) {
  BeamCache beams;
  Tube tube;
  tube.aluminium_mm = -1.0;
  EXPECT_FALSE(control_exposure(body(10.0), CArm{}, tube, DoseMode::kNormal, 15.0, {}, beams).has_value());
}

}  // namespace
}  // namespace trocar::xray
