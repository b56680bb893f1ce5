#include "ultrasound/probe/probe_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "ultrasound/probe/detail/view_anatomy.h"
#include "ultrasound/probe/detail/view_rays.h"
#include "ultrasound/probe/probe_contact.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {
namespace {

using detail::ViewAnatomy;
using detail::ViewRays;

constexpr double kFarthestSkin_mm = 400.0;
constexpr double kSearchStep_mm = 4.0;
constexpr double kFreeSlant = radians(30.0);  ///< Between beam and skin, without a penalty.
constexpr int kProbedLines = 33;
constexpr double kWayStep_mm = 2.0;

// Weights of the cost of a pose; assumed, chosen on the embedded patients and two CTs.
constexpr double kUnseenCost = 2.0;   ///< An invisible subject.
constexpr double kThroughCost = 0.7;  ///< A path without any of the structures that it should pass.
constexpr double kShiftCost = 0.15;   ///< A position at the end of the search.
constexpr double kSlantCost = 2.0;    ///< Per rad beyond kFreeSlant.
constexpr double kContactCost = 1.5;  ///< A face without contact.
constexpr double kDentCost = 0.04;    ///< Per mm of the deepest indentation beyond kFreeDent_mm.
constexpr double kFreeDent_mm = 9.0;
constexpr double kFarCost = 0.4;   ///< A position at the end of the wide search.
constexpr double kTurnCost = 0.2;  ///< A plane rotated by kMostTurn.

// The wide search.
constexpr double kFarthest = radians(60.0);  ///< From the direction of the view.
constexpr double kFarStep = radians(8.0);
constexpr double kMostTurn = radians(60.0);  ///< Of the plane around the beam.
constexpr int kTurns = 2;                    ///< Steps to each side.
constexpr double kRefine_mm = 12.0;

/// First intersection with the skin from a point inside; empty if the line leaves the volume before.
std::optional<Vec3> skin_along(const ViewAnatomy& ground, const Vec3& from_P, const Vec3& direction_P) {
  double inside_mm = 0.0;
  for (double way_mm = 0.0; way_mm < kFarthestSkin_mm; way_mm += kWayStep_mm) {
    const Vec3 p_P = from_P + way_mm * direction_P;
    if (!ground.contains(p_P)) return std::nullopt;
    const double skin_mm = ground.skin_mm(p_P);
    if (skin_mm < 0.0) {
      inside_mm = skin_mm;
      continue;
    }
    const double back_mm = way_mm > 0.0 ? kWayStep_mm * skin_mm / (skin_mm - inside_mm) : 0.0;
    return Vec3(p_P - back_mm * direction_P);
  }
  return std::nullopt;
}

/// The skin in the direction of the view, else in one closer to the shortest way out: a truncated body or a block of
/// tissue has no skin at its sides.
std::optional<Vec3> find_skin(const ViewAnatomy& ground, const Vec3& target_P, const Vec3& direction_P) {
  const Vec3 shortest = ground.skin_normal(target_P);
  for (const double share : {0.0, 0.5, 1.0}) {
    const Vec3 between = (1.0 - share) * direction_P + share * shortest;
    if (between.norm() < 1e-6) continue;
    if (const auto skin_P = skin_along(ground, target_P, between.normalized())) return skin_P;
  }
  return std::nullopt;
}

/// +x of T before it is made perpendicular to the beam.
Vec3 marker(const ProbeView& view, const Vec3& beam_P) {
  constexpr double kFromFlank = 0.8;  // cosine: the patient's right is nearly parallel to the beam
  if (view.plane == ScanPlane::kLongitudinal) return Vec3::UnitZ();
  if (std::abs(beam_P.x()) < kFromFlank) return -Vec3::UnitX();
  return Vec3::UnitZ().cross(beam_P);
}

/// `turn_rad`: in addition to the angle of the view.
Mat3 orientation(const ProbeView& view, const Vec3& beam_P, double turn_rad = 0.0) {
  const Vec3 wish = marker(view, beam_P);
  Vec3 x = wish - wish.dot(beam_P) * beam_P;
  x = x.norm() > 1e-3 ? Vec3(x.normalized()) : Vec3(beam_P.unitOrthogonal());
  x = Eigen::AngleAxisd(view.angle_rad + turn_rad, beam_P) * x;
  Mat3 R_PT;
  R_PT << x, beam_P, x.cross(beam_P);
  return R_PT;
}

/// A pose that was tried.
struct Candidate {
  Pose X_PT;
  ViewVisibility visibility;
  double cost = std::numeric_limits<double>::infinity();
  Vec3 skin_P = Vec3::Zero();
  double turn_rad = 0.0;
};

class Placer {
 public:
  Placer(const ViewAnatomy& ground, const ProbeView& view, const Transducer& transducer, const Vec3& target_P)
      : ground_(ground),
        view_(view),
        scan_(make_scan_geometry(transducer, view.depth_mm, kProbedLines, 16)),
        rays_(ground, view, transducer, target_P),
        target_P_(target_P) {}

  /// The face on a point of the skin; `extra_cost` for the distance from the point of the view.
  Candidate place(const Vec3& skin_P, double turn_rad, double extra_cost) const {
    const Vec3 beam_P = (target_P_ - skin_P).normalized();
    Candidate candidate;
    candidate.skin_P = skin_P;
    candidate.turn_rad = turn_rad;
    const FaceFit fit = fit_face(ground_.patient.skin_distance_mm, scan_, skin_P, orientation(view_, beam_P, turn_rad),
                                 view_.pressed_mm);
    candidate.X_PT = fit.X_PT;
    candidate.visibility = rays_.measure(fit.X_PT);
    const double slant = std::acos(std::clamp(-ground_.skin_normal(skin_P).dot(candidate.X_PT.R().col(1)), -1.0, 1.0));
    candidate.cost = kUnseenCost * (1.0 - candidate.visibility.visible) + way_cost(candidate.X_PT) + extra_cost +
                     kSlantCost * std::max(slant - kFreeSlant, 0.0) + kContactCost * (1.0 - fit.touching) +
                     kDentCost * std::max(fit.dent_mm - kFreeDent_mm, 0.0);
    return candidate;
  }

  /// The best pose within a distance along the skin; must have a lower cost than `best`.
  Candidate search_near(const Vec3& skin_P, double turn_rad, double reach_mm, double extra_cost, Candidate best) const {
    const Mat3 R_PT = orientation(view_, (target_P_ - skin_P).normalized(), turn_rad);
    const Vec3 normal = ground_.skin_normal(skin_P);
    const Vec3 along_x = (R_PT.col(0) - R_PT.col(0).dot(normal) * normal).normalized();
    const Vec3 along_z = normal.cross(along_x);
    const int steps = static_cast<int>(reach_mm / kSearchStep_mm);
    for (int v = -steps; v <= steps; ++v) {
      for (int u = -steps; u <= steps; ++u) {
        const double shift_share = std::hypot(u, v) / std::max(steps, 1);
        if (shift_share > 1.0) continue;
        const bool is_middle = u == 0 && v == 0;
        const Vec3 place_P =
            is_middle ? skin_P : ground_.on_skin(skin_P + kSearchStep_mm * (u * along_x + v * along_z));
        if (!is_middle && !ground_.contains(place_P)) continue;
        const Candidate candidate = place(place_P, turn_rad, extra_cost + kShiftCost * shift_share * shift_share);
        if (candidate.cost < best.cost) best = candidate;
      }
    }
    return best;
  }

  /// The best pose in directions from the target within kFarthest of the view's direction, with rotations of the plane.
  Candidate search_far(Candidate best) const {
    const Vec3 middle = view_.direction_P, side = middle.unitOrthogonal(), other = middle.cross(side);
    const double before = best.cost;
    double far_cost = 0.0;
    for (double away = 0.0; away <= kFarthest + 1e-9; away += kFarStep) {
      const int around = std::max(1, static_cast<int>(std::lround(2.0 * std::numbers::pi * std::sin(away) / kFarStep)));
      for (int n = 0; n < around; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / around;
        const Vec3 direction =
            std::cos(away) * middle + std::sin(away) * (std::cos(angle) * side + std::sin(angle) * other);
        const auto skin_P = skin_along(ground_, target_P_, direction);
        if (!skin_P) continue;
        for (int turn = -kTurns; turn <= kTurns; ++turn) {
          const double turned = static_cast<double>(turn) / kTurns;
          const double extra = kFarCost * (away / kFarthest) * (away / kFarthest) + kTurnCost * turned * turned;
          const Candidate candidate = place(*skin_P, kMostTurn * turned, extra);
          if (candidate.cost >= best.cost) continue;
          best = candidate;
          far_cost = extra;
        }
      }
    }
    if (best.cost == before) return best;
    return search_near(best.skin_P, best.turn_rad, kRefine_mm, far_cost, best);
  }

 private:
  /// Structures on a scanline down to the target's depth.
  struct Way {
    double seen = 1.0;     ///< Share in front of bone or gas.
    double through = 0.0;  ///< Share in structures that it should pass.
    bool is_at_bone = false;
  };

  Way walk(const Pose& X_PT, double line, double depth_mm) const {
    const Vec2 origin = scan_.line_origin(line);
    const Vec2 direction = scan_.line_direction(line);
    const Vec3 from_P = X_PT * Vec3(origin.x(), origin.y(), 0.0);
    const Vec3 direction_P = X_PT.R() * Vec3(direction.x(), direction.y(), 0.0);
    Way way;
    for (double at_mm = 0.0; at_mm < depth_mm; at_mm += kWayStep_mm) {
      const Vec3 p_P = from_P + at_mm * direction_P;
      if (ground_.skin_mm(p_P) > 0.0) continue;
      const std::uint8_t label = ground_.label_at(p_P);
      way.is_at_bone = ground_.is_bone[label];
      if (way.is_at_bone || ground_.is_gas_at(p_P) || ground_.is_lung[label] || !ground_.contains(p_P)) {
        way.seen = at_mm / depth_mm;
        return way;
      }
      if (ground_.is_through[label]) way.through += kWayStep_mm / depth_mm;
    }
    return way;
  }

  double way_cost(const Pose& X_PT) const {
    const double depth_mm = (target_P_ - X_PT.p()).norm();
    const double middle = scan_.middle_line();
    double hidden = 0.0, missed = 0.0, weights = 0.0;
    std::array<double, 2> bone{};  // per side
    int in_side = 0;
    for (int n = 0; n < kProbedLines; ++n) {
      const double off = (n - middle) / middle;  // -1..1
      const Way way = walk(X_PT, n, depth_mm);
      const double weight = std::exp(-0.5 * std::pow(off / middle_share(), 2));
      weights += weight;
      missed += weight * (1.0 - way.through);
      hidden += weight * (view_.bone == BonePreference::kShow ? 1.0 - (way.is_at_bone ? 1.0 : 0.0) : 1.0 - way.seen);
      if (off < -kSide) ++in_side;
      if (std::abs(off) > kSide && way.is_at_bone) bone[off < 0.0 ? 0 : 1] += 1.0;
    }
    double cost = hidden / weights;
    if (!view_.through.empty()) cost += kThroughCost * missed / weights;
    if (view_.bone == BonePreference::kBeside) {
      for (const double lines : bone) cost += 1.0 - std::min(lines / (kRibShare * in_side), 1.0);
    }
    return cost;
  }

  /// Standard deviation of the scanlines' weights, in half widths; between ribs only the centre is free.
  double middle_share() const { return view_.bone == BonePreference::kBeside ? 0.2 : 0.4; }
  static constexpr double kSide = 0.3;
  static constexpr double kRibShare = 0.3;  ///< Share of a side's scanlines blocked by a rib.

  const ViewAnatomy& ground_;
  const ProbeView& view_;
  ScanGeometry scan_;
  ViewRays rays_;
  Vec3 target_P_;
};

}  // namespace

Result<ProbePlacement> place_probe(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                   const Transducer& transducer) {
  if (patient.labels.empty()) return fail("the patient has no voxels", patient.name, "build the patient again");
  TROCAR_TRY(const Vec3 target_P, detail::find_target_point(patient, view));
  const ViewAnatomy ground(patient, view);
  const Placer placer(ground, view, transducer, target_P);
  Candidate best;
  if (const std::optional<Vec3> skin_P = find_skin(ground, target_P, view.direction_P))
    best = placer.search_near(*skin_P, 0.0, view.search_mm, 0.0, best);
  if (best.visibility.visible < kEnoughVisible && view.search_mm > 0.0) best = placer.search_far(best);
  if (!std::isfinite(best.cost))
    return fail(fmt::format("no skin in the direction of the view \"{}\": the CT ends before it", view.name),
                patient.name, "choose another view");
  return ProbePlacement{best.X_PT, best.visibility};
}

}  // namespace trocar::ultrasound
