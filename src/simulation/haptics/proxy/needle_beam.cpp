#include "haptics/proxy/needle_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace trocar::haptics {
namespace {

/// Compliance of the shaft's end assembled so far, clamp to node: deflection and slope per unit force and moment.
struct EndCompliance {
  double w_per_force = 0.0;
  double w_per_moment = 0.0;  ///< Equals the slope per unit force.
  double slope_per_moment = 0.0;
};

/// A node with its spring, seen from the clamp: the load point of the rest of the shaft.
struct Node {
  EndCompliance compliance;
  Vec3 deflection = Vec3::Zero();
  double turned = 0.0;  ///< Deflection per rotation of the grip.
  double stiffness = 0.0;
};

/// Adds a span of shaft: its own bending, and the rotation of the previous end as a lever.
EndCompliance after_span(const EndCompliance& c, double h, double ei) noexcept {
  return {c.w_per_force + 2.0 * h * c.w_per_moment + h * h * c.slope_per_moment + h * h * h / (3.0 * ei),
          c.w_per_moment + h * c.slope_per_moment + h * h / (2.0 * ei), c.slope_per_moment + h / ei};
}

/// A spring at the end increases the stiffness; `share` is the remaining part of its compliance.
EndCompliance with_spring(const EndCompliance& c, double stiffness, double share) noexcept {
  return {c.w_per_force * share, c.w_per_moment * share,
          c.slope_per_moment - c.w_per_moment * c.w_per_moment * stiffness * share};
}

double longest(const BeamSolution& solution) noexcept {
  double most = 0.0;
  for (int i = 0; i < solution.node_count; ++i) {
    const double length = solution.deflection_mm[static_cast<std::size_t>(i)].stableNorm();
    if (!(length <= most)) most = length;
    if (!std::isfinite(length)) return length;
  }
  return most;
}

void limit(BeamSolution& solution, double most_mm) noexcept {
  const auto deflections = std::span(solution.deflection_mm).first(static_cast<std::size_t>(solution.node_count));
  const bool is_within =
      std::ranges::all_of(deflections, [&](const Vec3& v) { return v.squaredNorm() <= most_mm * most_mm; });
  if (is_within) return;
  const double most = longest(solution);
  if (most <= most_mm) return;
  solution.is_bound = true;
  const double scale = std::isfinite(most) ? most_mm / most : 0.0;
  for (Vec3& deflection : solution.deflection_mm)
    deflection = std::isfinite(most) ? Vec3(deflection * scale) : Vec3::Zero();
}

constexpr double kRigid_n_per_mm = 1e9;  // Stiffer than any tissue; keeps the numbers finite.

double usable(double stiffness) noexcept {
  return stiffness > 0.0 && std::isfinite(stiffness) ? std::min(stiffness, kRigid_n_per_mm) : 0.0;
}

}  // namespace

double bending_stiffness_n_mm2(const NeedleGeometry& needle, bool is_stylet_in) noexcept {
  constexpr double kNPerMm2PerGpa = 1000.0;
  const auto second_moment = [](double r) { return std::numbers::pi / 4.0 * r * r * r * r; };
  double moment = second_moment(needle.radius_mm) - second_moment(needle.inner_radius_mm);
  if (is_stylet_in) moment += second_moment(needle.stylet_radius_mm);
  return needle.young_gpa * kNPerMm2PerGpa * moment;
}

NeedleBeam make_needle_beam(const NeedleGeometry& needle, bool is_stylet_in) noexcept {
  const int nodes = needle.body_proxies + 1;
  return {nodes, needle.length_mm / nodes, bending_stiffness_n_mm2(needle, is_stylet_in)};
}

BeamSolution solve_beam(const NeedleBeam& beam, const BeamBed& bed) noexcept {
  BeamSolution solution;
  const int count = std::clamp(beam.node_count, 1, kMaxBeamNodes);
  const double h = beam.spacing_mm;
  solution.node_count = count;

  // Outwards: compliance of clamp, spans and springs up to each node. All terms have the same sign: no cancellation.
  std::array<Node, kMaxBeamNodes> nodes;
  EndCompliance end;
  Vec3 deflection = Vec3::Zero();
  Vec3 slope = Vec3::Zero();
  double turned = 0.0;
  double turned_slope = 0.0;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    end = after_span(end, h, beam.bending_stiffness_n_mm2);
    deflection += h * slope;
    turned += h * turned_slope;
    const double k = usable(bed.stiffness_n_per_mm[index]);
    const double share = 1.0 / (1.0 + k * end.w_per_force);
    if (k > 0.0) {
      const Vec3 pull = k * share * (bed.offset_mm[index] - deflection);
      slope += end.w_per_moment * pull;
      deflection += end.w_per_force * pull;
      const double turned_pull =
          -k * share * (h * (i + 1) + turned);  // the straight shaft's node has moved by its lever
      turned_slope += end.w_per_moment * turned_pull;
      turned += end.w_per_force * turned_pull;
      end = with_spring(end, k, share);
    }
    nodes[index] = {end, deflection, turned, k};
  }

  // Inwards: force and moment of everything beyond a node; once with the load of the foundation, once with that of a
  // rotated grip, once with one newton at the tip.
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double turned_force = 0.0;
  double turned_moment = 0.0;
  double tip_force = 1.0;
  double tip_moment = 0.0;
  for (int i = count - 1; i >= 0; --i) {
    const auto index = static_cast<std::size_t>(i);
    const auto& [c, held, held_turned, k] = nodes[index];
    const Vec3 w = held + c.w_per_force * force + c.w_per_moment * moment;
    const double w_tip = c.w_per_force * tip_force + c.w_per_moment * tip_moment;
    solution.deflection_mm[index] = w;
    solution.per_tip_force_mm_n[index] = w_tip;
    if (k > 0.0) force += k * (bed.offset_mm[index] - w);
    moment += h * force;
    const double w_turned = held_turned + c.w_per_force * turned_force + c.w_per_moment * turned_moment;
    turned_force -= k * (h * (i + 1) + w_turned);
    turned_moment += h * turned_force;
    tip_force -= k * w_tip;
    tip_moment += h * tip_force;
  }
  solution.turning_nmm_per_rad = std::max(0.0, -turned_moment);
  limit(solution, kMaxDeflection * h * count);
  return solution;
}

GripStiffness grip_stiffness(const NeedleBeam& beam, const BeamBed& bed) noexcept {
  // From the tip inwards: stiffness K of everything beyond, to deflection and slope. A span with compliance C and lever
  // T transforms it to T' K (1 + C K)^-1 T.
  const double h = beam.spacing_mm;
  const double ei = beam.bending_stiffness_n_mm2;
  const double c_ww = h * h * h / (3.0 * ei);
  const double c_ws = h * h / (2.0 * ei);
  const double c_ss = h / ei;
  double k_ww = 0.0;
  double k_ws = 0.0;
  double k_ss = 0.0;
  for (int i = std::clamp(beam.node_count, 1, kMaxBeamNodes) - 1; i >= 0; --i) {
    k_ww += usable(bed.stiffness_n_per_mm[static_cast<std::size_t>(i)]);
    const double determinant = k_ww * k_ss - k_ws * k_ws;
    const double share =
        1.0 / (1.0 + c_ww * k_ww + 2.0 * c_ws * k_ws + c_ss * k_ss + (c_ww * c_ss - c_ws * c_ws) * determinant);
    const double soft_ww = (k_ww + c_ss * determinant) * share;
    const double soft_ws = (k_ws - c_ws * determinant) * share;
    const double soft_ss = (k_ss + c_ww * determinant) * share;
    k_ww = soft_ww;
    k_ws = soft_ws + h * soft_ww;
    k_ss = soft_ss + 2.0 * h * soft_ws + h * h * soft_ww;
  }
  return {k_ww, k_ss};
}

}  // namespace trocar::haptics
