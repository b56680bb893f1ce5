#include <gtest/gtest.h>

#include "xray/fluoroscopy/exposure_control.h"

namespace trocar::xray {
namespace {

TEST(Dose, FallsWithTheSquareOfTheDistance) {
  EXPECT_DOUBLE_EQ(at_distance(0.08, 1000.0), 0.08);
  EXPECT_DOUBLE_EQ(at_distance(0.08, 500.0), 0.32);
  EXPECT_DOUBLE_EQ(at_distance(0.08, 2000.0), 0.02);
}

TEST(Dose, IsMeasuredAtTheReferencePoint) {
  CArm arm;
  arm.source_isocentre_mm = 650.0;  // the reference point is at 500 mm
  Dose dose;
  add_pulses(30, 0.2, 0.05, arm, dose);
  EXPECT_NEAR(dose.air_kerma_mgy, 30 * 0.2 * 0.05 * 4.0, 1e-12);
  EXPECT_EQ(dose.pulses, 30);
  add_pulses(10, 0.2, 0.05, arm, dose);
  EXPECT_NEAR(dose.air_kerma_mgy, 40 * 0.2 * 0.05 * 4.0, 1e-12);
}

TEST(Dose, HasTheSameAreaProductAtEveryDistance) {
  CArm arm;
  arm.collimation = {0.5, 0.8};
  Dose dose;
  add_pulses(1, 1.0, 0.05, arm, dose);
  for (const double distance_mm : {200.0, 550.0, 1100.0}) {
    const double product = at_distance(0.05, distance_mm) * irradiated_area_cm2(arm, distance_mm);
    EXPECT_NEAR(dose.area_product_mgy_cm2, product, 1e-12) << distance_mm;
  }
  // At the detector: a field of 30 cm, of which 40 % are irradiated.
  EXPECT_NEAR(irradiated_area_cm2(arm, arm.source_detector_mm), 900.0 * 0.4, 1e-9);
}

}  // namespace
}  // namespace trocar::xray
