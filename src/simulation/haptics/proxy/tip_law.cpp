#include "haptics/proxy/tip_law.h"

#include <algorithm>
#include <cmath>

#include "volume/sampling.h"

namespace trocar::haptics {
namespace {

/// Gradient (HU/mm) by central differences of `scale_mm` to each side along the axes of A.
Vec3 gradient_at_scale(const volume::CtGrid& ct, const Vec3& p_A, double scale_mm) noexcept {
  const Vec3 index = ct.geometry.to_index(p_A);
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = (ct.geometry.R_PV.row(axis).transpose() * scale_mm).cwiseQuotient(ct.geometry.spacing_mm);
    slope[axis] =
        (volume::sample_linear_at_index(ct, index + step) - volume::sample_linear_at_index(ct, index - step)) /
        (2.0 * scale_mm);
  }
  return slope;
}

std::uint8_t wall_of(const HapticScene& scene, const TissueAt& there) noexcept {
  const std::uint8_t layer = scene.tissues[there.tissue].layer;
  return layer != kNoLayer && scene.layers[layer].is_wall ? layer : kNoLayer;
}

/// True if the outside air, with a CT's blur, affects the gradient at a point.
bool is_under_skin(const HapticScene& scene, const Vec3& p_A) noexcept {
  constexpr double kBlur_mm = 2.0;
  return volume::sample_linear(scene.patient->skin_distance_mm, p_A) > -(scene.transfer.gradient_scale_mm + kBlur_mm);
}

/// True if the labels decide on the border at a point: it belongs to a walled structure, which has its own threshold,
/// or to a labelled tissue that is cut and has no surface to pierce (a ligament).
bool is_border_of_label(const HapticScene& scene, const Vec3& p_A, const Vec3& normal_A) noexcept {
  const double reach_mm = 2.0 * scene.transfer.gradient_scale_mm;
  const TissueAt denser = tissue_at(scene, p_A + reach_mm * normal_A);
  if (wall_of(scene, denser) != wall_of(scene, tissue_at(scene, p_A - reach_mm * normal_A))) return true;
  const TissueLaw& law = scene.tissues[denser.tissue];
  return denser.label != 0 && denser.tissue != scene.skin && law.layer == kNoLayer && law.cutting_n > 0.0;
}

}  // namespace

TipLaw tip_law_at(const HapticScene& scene, const Vec3& p_A, const TissueAt& here) noexcept {
  TipLaw tip;
  if (here.tissue == 0) {
    tip.law = {};
    return tip;
  }
  tip.law = scene.transfer.at(volume::sample_linear(scene.patient->ct, p_A));
  const double labelled_n = scene.tissues[here.tissue].cutting_n;
  if (here.tissue == scene.skin || wall_of(scene, here) != kNoLayer)
    tip.law.resistance_n = labelled_n;
  else if (here.label != 0)  // a label without a wall may cover the edge of a bone or a calcification
    tip.law.resistance_n = std::max(labelled_n, tip.law.resistance_n);
  if (here.tissue == scene.skin) return tip;  // its border is the body's surface

  const anatomy::HuTransfer& transfer = scene.transfer;
  const Vec3 gradient = gradient_at_scale(scene.patient->ct, p_A, transfer.gradient_scale_mm);
  const double strength = gradient.norm();
  if (!(strength > transfer.gradient_none_hu_per_mm)) return tip;
  const Vec3 normal_A = gradient / strength;
  if (is_under_skin(scene, p_A) || is_border_of_label(scene, p_A, normal_A)) return tip;
  const double t = std::min(1.0, (strength - transfer.gradient_none_hu_per_mm) /
                                     (transfer.gradient_full_hu_per_mm - transfer.gradient_none_hu_per_mm));
  tip.normal = normal_A;
  tip.border = t * t * (3.0 - 2.0 * t);
  return tip;
}

TipLaw tip_law_now(const PatientNow& now, const Vec3& p_A, const TissueAt& here) noexcept {
  TipLaw tip = tip_law_at(now.scene, p_A, here);
  if (!now.motion.is_rest() && tip.border > 0.0)
    tip.normal = now.motion.gradient_to_now(p_A, tip.normal).stableNormalized();
  return tip;
}

double threshold_along_n(const TipLaw& tip, const Vec3& u) noexcept {
  const double along = tip.normal.dot(u);
  const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
  const double border_n = tip.law.normal_n * std::max(0.0, along) + tip.law.tangential_n * across;
  return tip.border * border_n + (1.0 - tip.border) * tip.law.resistance_n;
}

NeedleBalance balance_needle(const NeedleDrive& drive, double tissue_n_per_mm, double proxy_mm) noexcept {
  const stylus::CouplingParams& coupling = drive.coupling;
  const double push_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - drive.before_mm) -
                        tissue_n_per_mm * (drive.before_mm - proxy_mm) - drive.bed_n;
  const double slip_n = push_n - std::clamp(push_n, -drive.friction.dry_n, drive.friction.dry_n);
  const double denominator = coupling.stiffness_n_per_mm + tissue_n_per_mm + drive.bed_n_per_mm +
                             (coupling.damping_ns_per_mm + drive.friction.viscous_ns_per_mm) / drive.dt_s;
  NeedleBalance balance;
  const double way_mm = slip_n / denominator;
  balance.needle_mm = drive.before_mm + way_mm;
  balance.on_tip_n = tissue_n_per_mm * (balance.needle_mm - proxy_mm);
  balance.on_bed_n = drive.bed_n + drive.bed_n_per_mm * way_mm;
  balance.on_shaft_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - balance.needle_mm) -
                       coupling.damping_ns_per_mm * way_mm / drive.dt_s - balance.on_tip_n - balance.on_bed_n;
  const double follow = slip_n != 0.0 ? tissue_n_per_mm / denominator : 0.0;
  balance.tip_n_per_mm = tissue_n_per_mm * (1.0 - follow);
  return balance;
}

}  // namespace trocar::haptics
