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
};

ShaftTissue tissue_at_bin(const Channel& channel, const HapticScene& scene, std::size_t bin) noexcept {
  const TissueAt here{channel.tissue[bin], channel.label[bin]};
  if (here.tissue == 0) return {};  // Outside the body.
  const TissueLaw& labelled = scene.tissues[here.tissue];
  if (scene.transfer.knot_count == 0 || !is_read_from_ct(scene, here))
    return {labelled.stick_n_per_mm, labelled.viscosity_ns_per_mm};
  const anatomy::HuLaw law = scene.transfer.at(channel.hu[bin]);
  return {law.shaft_n_per_mm, law.shaft_viscosity_ns_per_mm};
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
    const double x = stiffness / factor(), x2 = x * x, x4 = x2 * x2;
    return std::pow(x4 * x4 * x4 / slenderness_per_kpa(), 1.0 / 13.0);
  }
};

const NeedleBeam& beam_of(const HapticScene& scene, bool is_stylet_in) noexcept {
  return is_stylet_in ? scene.beam_with_stylet : scene.beam_without_stylet;
}

double young_kpa_at_bin(const Channel& channel, const HapticScene& scene, std::size_t bin) noexcept {
  const TissueAt here{channel.tissue[bin], channel.label[bin]};
  if (here.tissue == 0) return 0.0;  // Outside the body.
  const bool is_of_hu = here.label == 0 && scene.transfer.knot_count > 0 && is_read_from_ct(scene, here);
  return is_of_hu ? scene.transfer.at(channel.hu[bin]).young_kpa : scene.tissues[here.tissue].young_kpa;
}

/// Young's modulus along the channel, from the skin to the tip: linear between the centres of cells and from zero at
/// the skin, so that the bed's stiffness and its change with depth are continuous.
class YoungAlong {
 public:
  struct At {
    double integral_kpa_mm;  ///< From the skin.
    double kpa;
    double slope;  ///< kPa/mm
  };

  YoungAlong(const Channel& channel, const HapticScene& scene, double tip_mm, double most_kpa) noexcept {
    constexpr double kDeepest_mm = Channel::kBins * Channel::kBin_mm;
    const double deepest_mm = tip_mm < kDeepest_mm ? std::max(0.0, tip_mm) : kDeepest_mm;
    const int last = static_cast<int>(deepest_mm / kShaftCell_mm + 0.5);
    for (int cell = 0; cell <= last; ++cell) {
      const int bin = std::min(bin_of((cell + 0.5) * kShaftCell_mm), channel.known_bins - 1);
      const double young_kpa = bin < 0 ? 0.0 : young_kpa_at_bin(channel, scene, static_cast<std::size_t>(bin));
      kpa_[static_cast<std::size_t>(cell) + 1] = std::min(young_kpa, most_kpa);
    }
    kpa_[0] = -kpa_[1];
    integral_[0] = 0.25 * kShaftCell_mm * kpa_[1];  // zero at the skin
    for (std::size_t n = 0; n <= static_cast<std::size_t>(last); ++n)
      integral_[n + 1] = integral_[n] + 0.5 * kShaftCell_mm * (kpa_[n] + kpa_[n + 1]);
  }

  /// Between the skin and the tip.
  At at(double s_mm) const noexcept {
    const auto n = static_cast<std::size_t>(s_mm / kShaftCell_mm + 0.5);
    const double slope = (kpa_[n + 1] - kpa_[n]) / kShaftCell_mm;
    const double from_mm = s_mm - (static_cast<double>(n) - 0.5) * kShaftCell_mm;
    const double kpa = kpa_[n] + slope * from_mm;
    return {integral_[n] + 0.5 * (kpa_[n] + kpa) * from_mm, kpa, slope};
  }

 private:
  static constexpr int kMost = static_cast<int>(Channel::kBins * Channel::kBin_mm / kShaftCell_mm) + 3;
  std::array<double, kMost> kpa_;       ///< At the centre of cell n - 1; the one before the skin mirrors the first one.
  std::array<double, kMost> integral_;  ///< From the skin to there.
};

/// Springs of the foundation, with a total stiffness within the device's limit, and their change with depth: both ends
/// of a piece move with the tip.
void fill_stiffness(HeldShaft& shaft, const Channel& channel, const HapticScene& scene, const NeedleBeam& beam,
                    double tip_mm) noexcept {
  BeamBed& bed = shaft.bed;
  const BedLaw law{2.0 * scene.needle.radius_mm, beam.bending_stiffness_n_mm2};
  const double most_kpa = law.young_kpa_of(scene.options.coupling.stiffness_n_per_mm / beam.spacing_mm);
  const YoungAlong young(channel, scene, tip_mm, most_kpa);
  YoungAlong::At from = young.at(0.0);
  double sum_n_per_mm = 0.0;
  double sum_stiffening = 0.0;
  for (int i = 0; i < beam.node_count; ++i) {
    const Piece piece = piece_of(beam, i, tip_mm);
    const double length_mm = piece.length_mm();
    if (!(length_mm > 0.0)) continue;
    const YoungAlong::At to = young.at(piece.to_mm);
    const double mean_kpa = (to.integral_kpa_mm - from.integral_kpa_mm) / length_mm;
    const double per_mm = law.stiffness_n_per_mm2(mean_kpa);
    const double per_kpa = mean_kpa > 0.0 ? kBedPower * per_mm / mean_kpa : 0.0;
    const bool is_growing = !(piece.from_mm > 0.0);  // the piece at the skin
    const double stiffening = (is_growing ? per_mm : 0.0) + per_kpa * (to.kpa - (is_growing ? mean_kpa : from.kpa));
    const auto index = static_cast<std::size_t>(i);
    shaft.growth_n_per_mm3[index] = per_kpa * (to.slope - (is_growing ? 0.0 : from.slope));
    bed.stiffness_n_per_mm[index] = per_mm * length_mm;
    shaft.stiffening_n_per_mm2[index] = stiffening;
    sum_n_per_mm += per_mm * length_mm;
    sum_stiffening += stiffening;
    from = to;  // the next piece begins there
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

/// Way from a point of the shaft to the channel: across the shaft and along it, and the channel's direction there.
struct ToChannel {
  Vec3 across_P;
  double along_mm;
  Vec3 tangent_P;
};

/// The way to a channel that is straight: linear along the shaft.
class ShaftFromLine {
 public:
  ShaftFromLine(const Channel& channel, const Pose& X_PN) noexcept : direction_P_(channel.direction_P) {
    const Vec3 axis_P = X_PN.R().col(2);
    // From the tip, and its change per mm towards the grip.
    const Vec3 to_line_P = across(channel.origin_P - X_PN.p(), direction_P_);
    const Vec3 to_line_per_mm_P = across(axis_P, direction_P_);
    across_P_ = across(to_line_P, axis_P);
    across_per_mm_P_ = across(to_line_per_mm_P, axis_P);
    along_mm_ = axis_P.dot(to_line_P);
    along_per_mm_ = axis_P.dot(to_line_per_mm_P);
  }
  bool is_finite() const noexcept {
    return across_P_.allFinite() && across_per_mm_P_.allFinite() && std::isfinite(along_mm_ + along_per_mm_);
  }
  ToChannel at(double behind_mm) const noexcept {
    return {across_P_ + behind_mm * across_per_mm_P_, along_mm_ + behind_mm * along_per_mm_, direction_P_};
  }

 private:
  Vec3 direction_P_, across_P_, across_per_mm_P_;
  double along_mm_, along_per_mm_;
};

/// The way to a channel that moves and bends with its tissue; `s_mm`: place on the channel beside that point.
ToChannel way_to_channel(const ChannelNow& course, const motion::PatientMotion& motion, const Pose& X_PN,
                         double behind_mm, double s_mm, double ahead_s) noexcept {
  const Vec3 axis_P = X_PN.R().col(2);
  const Vec3 tangent_P = course.tangent_P(s_mm);
  const Vec3 moved_P = ahead_s * motion.velocity(course.rest_A(s_mm));
  const Vec3 way_P = across(course.point_P(s_mm) + moved_P - (X_PN.p() - behind_mm * axis_P), tangent_P);
  return {across(way_P, axis_P), axis_P.dot(way_P), tangent_P};
}

/// Energy of tissue and shaft, and its growth with depth: at equilibrium only the change of the stiffness counts.
void store_energy(HeldShaft& shaft) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(shaft.beam.node_count); ++i) {
    if (!(shaft.bed.stiffness_n_per_mm[i] > 0.0)) continue;
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

double tissue_drift_mm_per_s(const Channel& channel, const PatientNow& now, double tip_mm) noexcept {
  if (channel.nodes.count == 0 || !(tip_mm > 0.0)) return 0.0;
  constexpr int kPlaces = 8;
  const ChannelNow course(channel, now.motion);
  const auto along_mm_per_s = [&](double s_mm) {
    return course.tangent_P(s_mm).dot(now.motion.velocity(course.rest_A(s_mm)));
  };
  double mean = 0.0;
  for (int i = 0; i < kPlaces; ++i) mean += along_mm_per_s(tip_mm * (i + 0.5) / kPlaces) / kPlaces;
  return along_mm_per_s(tip_mm) - mean;
}

HeldShaft hold_shaft(const Channel& channel, const PatientNow& now, const Pose& X_PN, double tip_mm, bool is_stylet_in,
                     double ahead_s) noexcept {
  const HapticScene& scene = now.scene;
  NeedleBeam beam = beam_of(scene, is_stylet_in);
  HeldShaft shaft;
  shaft.beam.node_count = beam.node_count;
  const ShaftFromLine line(channel, X_PN);
  if (!line.is_finite()) {
    shaft.beam.is_bound = true;
    return shaft;
  }
  const ChannelNow course(channel, now.motion);
  shaft.X_PN = X_PN;
  shaft.line_P = channel.direction_P;
  shaft.is_straight = channel.nodes.count == 0;
  if (!shaft.is_straight) shaft.bent_P.fill(shaft.line_P);
  fill_stiffness(shaft, channel, scene, beam, tip_mm);
  const double most_mm = kMaxDeflection * scene.needle.length_mm;
  bool is_far = false;
  for (int i = 0; i < beam.node_count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (!(shaft.bed.stiffness_n_per_mm[index] > 0.0)) continue;
    const double behind_mm = beam.spacing_mm * (beam.node_count - 1 - i);
    const ToChannel way = shaft.is_straight
                              ? line.at(behind_mm)
                              : way_to_channel(course, now.motion, X_PN, behind_mm, tip_mm - behind_mm, ahead_s);
    const Vec3& offset_P = way.across_P;
    if (!shaft.is_straight) shaft.bent_P[index] = way.tangent_P;
    shaft.along_mm[index] = std::clamp(way.along_mm, -most_mm, most_mm);
    shaft.bed.offset_mm[index] = limited(offset_P, most_mm);
    is_far = is_far || shaft.bed.offset_mm[index] != offset_P;
  }
  if (scene.options.has_bending) {
    shaft.beam = solve_beam(beam, shaft.bed);
    shaft.turning_nmm_per_rad = shaft.beam.turning_nmm_per_rad;
  } else {
    beam.bending_stiffness_n_mm2 = std::numeric_limits<double>::infinity();
    shaft.turning_nmm_per_rad = grip_stiffness(beam, shaft.bed).turning_nmm_per_rad;
  }
  const double turning = shaft.turning_nmm_per_rad;
  if (turning > kMostTurning_nmm_per_rad) shaft.share = kMostTurning_nmm_per_rad / turning;
  shaft.beam.is_bound = shaft.beam.is_bound || is_far;
  store_energy(shaft);
  return shaft;
}

bool is_torn(const Channel& channel, const PatientNow& now, const Pose& X_PN, double tip_mm) noexcept {
  const ChannelNow course(channel, now.motion);
  const auto beside_mm = [&](double behind_tip_mm) {
    const Vec3 shaft_P = X_PN.p() - behind_tip_mm * X_PN.R().col(2);
    if (channel.nodes.count == 0) return across(shaft_P - channel.origin_P, channel.direction_P).norm();
    const double s_mm = tip_mm - behind_tip_mm;
    return across(shaft_P - course.point_P(s_mm), course.tangent_P(s_mm)).norm();
  };
  const double length_mm = now.scene.needle.length_mm, most_mm = kMaxDeflection * length_mm;
  return std::max(beside_mm(0.0), beside_mm(std::min(tip_mm, length_mm))) > most_mm;
}

ShaftReaction react(const HeldShaft& shaft, const HapticScene& scene, const Vec3& tip_force_P) noexcept {
  const Vec3 axis_P = shaft.X_PN.R().col(2);
  const Vec3 tip_P = limited(across(limited(tip_force_P, kMostTipForce_n), axis_P), kMostTipForce_n);
  const double spacing_mm = scene.beam_with_stylet.spacing_mm;
  const double most_mm = kMaxDeflection * scene.needle.length_mm;
  ShaftReaction reaction;
  const int nodes = reaction.bent.node_count = shaft.beam.node_count;
  std::array<Vec3, kMaxBeamNodes>& deflection_P = reaction.bent.deflection_mm;
  double largest_mm2 = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const auto index = static_cast<std::size_t>(i);
    deflection_P[index] = shaft.beam.deflection_mm[index] + shaft.beam.per_tip_force_mm_n[index] * tip_P;
    largest_mm2 = std::max(largest_mm2, deflection_P[index].squaredNorm());
  }
  const double scale = largest_mm2 > most_mm * most_mm ? most_mm / std::sqrt(largest_mm2) : 1.0;
  Vec3 moment_P = Vec3::Zero();  // sum of lever times force
  for (int i = 0; i < nodes; ++i) {
    const auto index = static_cast<std::size_t>(i);
    deflection_P[index] *= scale;
    const double k = shaft.share * shaft.bed.stiffness_n_per_mm[index];
    const Vec3 bed_P = k * (shaft.bed.offset_mm[index] - deflection_P[index]);
    // A motion along the channel does not stretch the bed.
    Vec3 force_P = across(bed_P, shaft.is_straight ? shaft.line_P : shaft.bent_P[index]);
    if (i == nodes - 1) force_P += shaft.share * tip_P;
    reaction.wrench_P.force_n += force_P;
    moment_P += spacing_mm * (i + 1) * force_P + shaft.along_mm[index] * bed_P;
  }
  reaction.wrench_P.torque_nmm = axis_P.cross(moment_P);
  return reaction;
}

Vec3 bevel_force_P(const NeedleGeometry& needle, const Pose& X_PN, double axial_resistance_n) noexcept {
  if (!std::isfinite(axial_resistance_n) || !X_PN.is_finite()) return Vec3::Zero();
  const double sideways_n = needle.bevel_share * std::max(0.0, axial_resistance_n);
  return -std::min(sideways_n, kMostTipForce_n) * X_PN.R().col(1);
}

}  // namespace trocar::haptics
