#include "haptics/insertion/soft_column.h"

#include <algorithm>
#include <numbers>

#include "haptics/contact/contact_column.h"
#include "volume/sampling.h"

namespace trocar::haptics {
namespace {

double young_kpa(const HapticScene& scene, const Vec3& p_A) noexcept {
  const TissueAt here = tissue_at(scene, p_A);
  if (is_read_from_ct(scene, here) && scene.transfer.knot_count > 0 && !scene.patient->ct.empty())
    return scene.transfer.at(volume::sample_linear(scene.patient->ct, p_A)).young_kpa;
  return scene.tissues[here.tissue].young_kpa;
}

}  // namespace

double SoftColumn::depression_mm(double force_n) const noexcept {
  if (!(force_n > 0.0)) return 0.0;
  const double pressure = force_n / area_mm2;
  double depression_mm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i) {
    const double load = pressure * share[i];
    depression_mm += thickness_mm[i] * load / (plane_n_per_mm2[i] + load);
  }
  return depression_mm;
}

SoftColumn soft_column(const PatientNow& now, const Vec3& surface_P, const Vec3& inward_P, double radius_mm,
                       double least_kpa) noexcept {
  SoftColumn column;
  column.area_mm2 = std::numbers::pi * radius_mm * radius_mm;
  for (std::size_t i = 0; i < kColumnCells; ++i) {
    const double from_mm = kCellBorder_mm[i];
    const double to_mm = kCellBorder_mm[i + 1];
    const double young = young_kpa(now.scene, now.motion.to_rest(surface_P + 0.5 * (from_mm + to_mm) * inward_P));
    if (young >= kRigid_kpa || !(young > 0.0)) break;
    column.thickness_mm[i] = to_mm - from_mm;
    column.share[i] = (settlement_mm(to_mm, radius_mm) - settlement_mm(from_mm, radius_mm)) / (to_mm - from_mm);
    column.plane_n_per_mm2[i] =
        kNPerMm2PerKpa * std::max({young, least_kpa, kSoftest_kpa}) / (1.0 - kPoisson * kPoisson);
    ++column.cells;
  }
  return column;
}

}  // namespace trocar::haptics
