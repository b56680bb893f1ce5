#include "haptics/proxy/body_proxies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/insertion/insertion_law.h"

namespace trocar::haptics {
namespace {

constexpr double kTissuePoisson = 0.5;      // Soft tissue keeps its volume.
constexpr double kMostTipForce_n = 1000.0;  // Beyond any device: keeps the numbers finite.

/// A vector clamped to a length; zero if it is not finite.
Vec3 limited(const Vec3& v, double most) noexcept {
  if (v.squaredNorm() <= most * most) return v;
  const double length = v.stableNorm();
  if (!std::isfinite(length)) return Vec3::Zero();
  return length > most ? Vec3(v * (most / length)) : v;
}

Vec3 across(const Vec3& v, const Vec3& axis) noexcept {
  return v - axis * axis.dot(v);
}

/// Resistance of the shaft in one cell of the channel.
struct ShaftTissue {
  double dry_n_per_mm = 0.0;
  double viscosity_ns_per_mm = 0.0;
  double young_kpa = 0.0;
};

ShaftTissue tissue_at_bin(const Channel& channel, const HapticScene& scene, std::size_t bin) noexcept {
  const TissueAt here{channel.tissue[bin], channel.label[bin]};
  if (here.tissue == 0) return {};  // Outside the body.
  const TissueLaw& labelled = scene.tissues[here.tissue];
  if (scene.transfer.knot_count == 0 || !is_read_from_ct(scene, here))
    return {labelled.stick_n_per_mm, labelled.viscosity_ns_per_mm, labelled.young_kpa};
  const anatomy::HuLaw law = scene.transfer.at(channel.hu[bin]);
  return {law.shaft_n_per_mm, law.shaft_viscosity_ns_per_mm, here.label != 0 ? labelled.young_kpa : law.young_kpa};
}

/// Part of the channel of one proxy, within the body.
struct Piece {
  double from_mm = 0.0;
  double to_mm = 0.0;

  double length_mm() const noexcept { return to_mm - from_mm; }
};

Piece piece_of(const NeedleBeam& beam, int node, double tip_mm) noexcept {
  const double deepest_mm = std::min(tip_mm, Channel::kBins * Channel::kBin_mm);
  const double middle_mm = deepest_mm - beam.spacing_mm * (beam.node_count - 1 - node);
  const double from_mm = std::max(0.0, middle_mm - 0.5 * beam.spacing_mm);
  const double to_mm = std::min(deepest_mm, middle_mm + 0.5 * beam.spacing_mm);
  return to_mm > from_mm ? Piece{from_mm, to_mm} : Piece{};
}

/// Sums over the cells of a piece: `add(tissue, length_mm)`. Cells are fixed in the channel, so that a sum changes
/// continuously as the needle slides.
template <class Add>
void for_each_cell(const Channel& channel, const HapticScene& scene, const Piece& piece, const Add& add) noexcept {
  if (channel.known_bins <= 0 || !(piece.to_mm > piece.from_mm)) return;
  const int first = static_cast<int>(piece.from_mm / kShaftCell_mm);
  const int last = static_cast<int>(piece.to_mm / kShaftCell_mm);
  for (int cell = first; cell <= last; ++cell) {
    const double begin_mm = cell * kShaftCell_mm;
    const double length_mm = std::min(piece.to_mm, begin_mm + kShaftCell_mm) - std::max(piece.from_mm, begin_mm);
    if (!(length_mm > 0.0)) continue;
    const int bin = std::min(bin_of(begin_mm + 0.5 * kShaftCell_mm), channel.known_bins - 1);
    add(tissue_at_bin(channel, scene, static_cast<std::size_t>(bin)), length_mm);
  }
}

constexpr double kBedPower = 13.0 / 12.0;  // of Young's modulus in the bed's stiffness

/// Stiffness of the tissue around a unit length of shaft (Vesic 1961), and the tissue with a given one.
struct BedLaw {
  double diameter_mm;
  double bending_stiffness_n_mm2;

  double factor() const noexcept { return 0.65 * kNPerMm2PerKpa / (1.0 - kTissuePoisson * kTissuePoisson); }
  double slenderness_per_kpa() const noexcept {
    const double d2 = diameter_mm * diameter_mm;
    return kNPerMm2PerKpa * d2 * d2 / bending_stiffness_n_mm2;
  }
  double stiffness_n_per_mm2(double young_kpa) const noexcept {
    return factor() * young_kpa * std::cbrt(std::sqrt(std::sqrt(slenderness_per_kpa() * young_kpa)));
  }
  double young_kpa_of(double stiffness) const noexcept {
    return std::pow(stiffness / factor(), 12.0 / 13.0) * std::pow(slenderness_per_kpa(), -1.0 / 13.0);
  }
};

const NeedleBeam& beam_of(const HapticScene& scene, bool is_stylet_in) noexcept {
  return is_stylet_in ? scene.beam_with_stylet : scene.beam_without_stylet;
}

/// Young's modulus of the tissue along a piece: linear between the centres of cells and from zero at the skin, so that
/// the bed's stiffness and its change with depth are continuous.
struct PieceYoung {
  double integral_kpa_mm = 0.0;
  double from_kpa = 0.0, to_kpa = 0.0;      // at its ends
  double from_slope = 0.0, to_slope = 0.0;  // kPa/mm
};
PieceYoung young_of(const Channel& channel, const HapticScene& scene, const Piece& piece, double most_kpa) noexcept {
  PieceYoung young;
  if (channel.known_bins <= 0) return young;
  const auto at_cell = [&](int cell) {  // zero at the skin
    const int bin = std::min(bin_of((std::max(cell, 0) + 0.5) * kShaftCell_mm), channel.known_bins - 1);
    const double kpa = std::min(tissue_at_bin(channel, scene, static_cast<std::size_t>(bin)).young_kpa, most_kpa);
    return cell < 0 ? -kpa : kpa;
  };
  const int first = static_cast<int>(std::floor(piece.from_mm / kShaftCell_mm - 0.5));
  const int last = static_cast<int>(std::floor(piece.to_mm / kShaftCell_mm - 0.5));
  double before_kpa = at_cell(first);
  for (int cell = first; cell <= last; ++cell) {  // from the centre of this cell to that of the next
    const double after_kpa = at_cell(cell + 1);
    const double slope = (after_kpa - before_kpa) / kShaftCell_mm;
    const double centre_mm = (cell + 0.5) * kShaftCell_mm;
    const double from_mm = std::max(piece.from_mm, centre_mm);
    const double to_mm = std::min(piece.to_mm, centre_mm + kShaftCell_mm);
    const double from_kpa = before_kpa + slope * (from_mm - centre_mm);
    young.to_kpa = before_kpa + slope * (to_mm - centre_mm);
    young.to_slope = slope;
    if (cell == first) {
      young.from_kpa = from_kpa;
      young.from_slope = slope;
    }
    young.integral_kpa_mm += 0.5 * (from_kpa + young.to_kpa) * std::max(0.0, to_mm - from_mm);
    before_kpa = after_kpa;
  }
  return young;
}

/// Springs of the foundation, with a total stiffness within the device's limit, and their change with depth: both ends
/// of a piece move with the tip.
void fill_stiffness(HeldShaft& shaft, const Channel& channel, const HapticScene& scene, const NeedleBeam& beam,
                    double tip_mm) noexcept {
  BeamBed& bed = shaft.bed;
  const BedLaw law{2.0 * scene.needle.radius_mm, beam.bending_stiffness_n_mm2};
  const double most_kpa = law.young_kpa_of(scene.options.coupling.stiffness_n_per_mm / beam.spacing_mm);
  double sum_n_per_mm = 0.0;
  double sum_stiffening = 0.0;
  for (int i = 0; i < beam.node_count; ++i) {
    const Piece piece = piece_of(beam, i, tip_mm);
    if (!(piece.length_mm() > 0.0)) continue;
    const PieceYoung young = young_of(channel, scene, piece, most_kpa);
    const double length_mm = piece.length_mm();
    const double mean_kpa = young.integral_kpa_mm / length_mm;
    const double per_mm = law.stiffness_n_per_mm2(mean_kpa);
    const double per_kpa = mean_kpa > 0.0 ? kBedPower * per_mm / mean_kpa : 0.0;
    const bool is_growing = !(piece.from_mm > 0.0);  // the piece at the skin
    const double stiffening =
        (is_growing ? per_mm : 0.0) + per_kpa * (young.to_kpa - (is_growing ? mean_kpa : young.from_kpa));
    shaft.growth_n_per_mm3[static_cast<std::size_t>(i)] =
        per_kpa * (young.to_slope - (is_growing ? 0.0 : young.from_slope));
    const auto index = static_cast<std::size_t>(i);
    bed.stiffness_n_per_mm[index] = per_mm * length_mm;
    shaft.stiffening_n_per_mm2[index] = stiffening;
    sum_n_per_mm += per_mm * length_mm;
    sum_stiffening += stiffening;
  }
  const double most_n_per_mm = 0.5 * scene.device.max_stiffness_n_per_mm;
  if (!(sum_n_per_mm > most_n_per_mm)) return;
  const double scale = most_n_per_mm / sum_n_per_mm;
  for (double& growth : shaft.growth_n_per_mm3) growth *= scale;
  for (std::size_t i = 0; i < bed.stiffness_n_per_mm.size(); ++i) {
    double& k = bed.stiffness_n_per_mm[i];
    shaft.stiffening_n_per_mm2[i] = scale * (shaft.stiffening_n_per_mm2[i] - k * sum_stiffening / sum_n_per_mm);
    k *= scale;
  }
}

/// Energy of tissue and shaft, and its growth with depth: at equilibrium only the change of the stiffness counts.
void store_energy(HeldShaft& shaft) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(shaft.beam.node_count); ++i) {
    const Vec3 stretch_P = shaft.bed.offset_mm[i] - shaft.beam.deflection_mm[i];
    shaft.energy_nmm += 0.5 * shaft.share * shaft.bed.stiffness_n_per_mm[i] * stretch_P.dot(shaft.bed.offset_mm[i]);
    const double square_mm2 = 0.5 * shaft.share * stretch_P.squaredNorm();
    shaft.out_n += square_mm2 * shaft.stiffening_n_per_mm2[i];
    shaft.out_n_per_mm += square_mm2 * shaft.growth_n_per_mm3[i];
  }
}

}  // namespace

ShaftResistance shaft_resistance(const Channel& channel, const HapticScene& scene, double tip_mm) noexcept {
  ShaftResistance resistance;
  const NeedleBeam& beam = scene.beam_with_stylet;
  for (int i = 0; i < beam.node_count; ++i) {
    const Piece piece = piece_of(beam, i, tip_mm);
    for_each_cell(channel, scene, piece, [&](const ShaftTissue& tissue, double length_mm) {
      resistance.dry_n += tissue.dry_n_per_mm * length_mm;
      resistance.viscous_ns_per_mm += tissue.viscosity_ns_per_mm * contact_area_cm2(scene.needle.radius_mm, length_mm);
    });
  }
  return resistance;
}

HeldShaft hold_shaft(const Channel& channel, const HapticScene& scene, const Pose& X_PN, double tip_mm,
                     bool is_stylet_in) noexcept {
  NeedleBeam beam = beam_of(scene, is_stylet_in);
  HeldShaft shaft;
  shaft.beam.node_count = beam.node_count;
  if (!X_PN.is_finite()) {
    shaft.beam.is_bound = true;
    return shaft;
  }
  shaft.X_PN = X_PN;
  shaft.line_P = channel.direction_P;
  fill_stiffness(shaft, channel, scene, beam, tip_mm);
  const Vec3 axis_P = X_PN.R().col(2);
  const double most_mm = kMaxDeflection * scene.needle.length_mm;
  bool is_far = false;
  for (int i = 0; i < beam.node_count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (!(shaft.bed.stiffness_n_per_mm[index] > 0.0)) continue;
    const Vec3 node_P = X_PN.p() - axis_P * (beam.spacing_mm * (beam.node_count - 1 - i));
    const Vec3 to_line_P = across(channel.origin_P - node_P, channel.direction_P);
    const Vec3 offset_P = across(to_line_P, axis_P);
    shaft.along_mm[index] = std::clamp(axis_P.dot(to_line_P), -most_mm, most_mm);
    shaft.bed.offset_mm[index] = limited(offset_P, most_mm);
    is_far = is_far || shaft.bed.offset_mm[index] != offset_P;
  }
  if (scene.options.has_bending)
    shaft.beam = solve_beam(beam, shaft.bed);
  else
    beam.bending_stiffness_n_mm2 = std::numeric_limits<double>::infinity();
  const double turning = shaft.turning_nmm_per_rad = grip_stiffness(beam, shaft.bed).turning_nmm_per_rad;
  if (turning > kMostTurning_nmm_per_rad) shaft.share = kMostTurning_nmm_per_rad / turning;
  shaft.beam.is_bound = shaft.beam.is_bound || is_far;
  store_energy(shaft);
  return shaft;
}

bool is_torn(const Channel& channel, const HapticScene& scene, const Pose& X_PN, double tip_mm) noexcept {
  const auto beside_mm = [&](double behind_tip_mm) {
    const Vec3 shaft_P = X_PN.p() - behind_tip_mm * X_PN.R().col(2);
    return across(shaft_P - channel.origin_P, channel.direction_P).norm();
  };
  const double most_mm = kMaxDeflection * scene.needle.length_mm;
  return std::max(beside_mm(0.0), beside_mm(std::min(tip_mm, scene.needle.length_mm))) > most_mm;
}

ShaftReaction react(const HeldShaft& shaft, const HapticScene& scene, const Vec3& tip_force_P) noexcept {
  const Vec3 axis_P = shaft.X_PN.R().col(2);
  const Vec3 tip_P = limited(across(limited(tip_force_P, kMostTipForce_n), axis_P), kMostTipForce_n);
  const double spacing_mm = scene.beam_with_stylet.spacing_mm;
  const double most_mm = kMaxDeflection * scene.needle.length_mm;
  ShaftReaction reaction;
  const int nodes = reaction.bent.node_count = shaft.beam.node_count;
  std::array<Vec3, kMaxBeamNodes>& deflection_P = reaction.bent.deflection_mm;
  double largest_mm = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const auto index = static_cast<std::size_t>(i);
    deflection_P[index] = shaft.beam.deflection_mm[index] + shaft.beam.per_tip_force_mm_n[index] * tip_P;
    largest_mm = std::max(largest_mm, deflection_P[index].norm());
  }
  const double scale = largest_mm > most_mm ? most_mm / largest_mm : 1.0;
  for (int i = 0; i < nodes; ++i) {
    const auto index = static_cast<std::size_t>(i);
    deflection_P[index] *= scale;
    const Vec3 lever_P = axis_P * (spacing_mm * (i + 1));
    const double k = shaft.share * shaft.bed.stiffness_n_per_mm[index];
    const Vec3 bed_P = k * (shaft.bed.offset_mm[index] - deflection_P[index]);
    Vec3 force_P = across(bed_P, shaft.line_P);  // a motion along the line does not stretch the bed
    if (i == nodes - 1) force_P += shaft.share * tip_P;
    reaction.wrench_P.force_n += force_P;
    reaction.wrench_P.torque_nmm += lever_P.cross(force_P) + shaft.along_mm[index] * axis_P.cross(bed_P);
  }
  return reaction;
}

Vec3 bevel_force_P(const NeedleGeometry& needle, const Pose& X_PN, double axial_resistance_n) noexcept {
  if (!std::isfinite(axial_resistance_n) || !X_PN.is_finite()) return Vec3::Zero();
  const double sideways_n = needle.bevel_share * std::max(0.0, axial_resistance_n);
  return -std::min(sideways_n, kMostTipForce_n) * X_PN.R().col(1);
}

}  // namespace trocar::haptics
