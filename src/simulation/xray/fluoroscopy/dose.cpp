#include "xray/fluoroscopy/dose.h"

namespace trocar::xray {
namespace {

constexpr double kReference_mm = 150.0;  ///< From the isocentre towards the source, IEC 60601-2-43.
constexpr double kMetre_mm = 1000.0;
constexpr double kCm2_per_mm2 = 0.01;

}  // namespace

double at_distance(double at_1_m, double distance_mm) noexcept {
  const double ratio = kMetre_mm / distance_mm;
  return at_1_m * ratio * ratio;
}

double reference_distance_mm(const CArm& arm) noexcept {
  return arm.source_isocentre_mm - kReference_mm;
}

double irradiated_area_cm2(const CArm& arm, double distance_mm) noexcept {
  const double edge_mm = arm.field_mm * distance_mm / arm.source_detector_mm;
  return kCm2_per_mm2 * edge_mm * edge_mm * arm.collimation[0] * arm.collimation[1];
}

void add_pulses(int pulses, double mas, double kerma_mgy_per_mas, const CArm& arm, Dose& dose) noexcept {
  const double distance_mm = reference_distance_mm(arm);
  const double kerma_mgy = pulses * mas * at_distance(kerma_mgy_per_mas, distance_mm);
  dose.pulses += pulses;
  dose.air_kerma_mgy += kerma_mgy;
  dose.area_product_mgy_cm2 += kerma_mgy * irradiated_area_cm2(arm, distance_mm);
}

}  // namespace trocar::xray
