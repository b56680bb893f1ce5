#include "ultrasound/probe_placement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "ultrasound/face_fit.h"
#include "ultrasound/scan_geometry.h"
#include "volume/sampling.h"

namespace trocar {
namespace {

constexpr double kFarthestSkin_mm = 400.0;
constexpr double kSlope_mm = 6.0;  ///< The skin's normal is that of a patch so large, not of a voxel.
constexpr double kSearchStep_mm = 4.0;
constexpr double kFreeSlant = 30.0 * std::numbers::pi / 180.0;  ///< Between beam and skin, without a malus.
constexpr int kLines = 33;
constexpr double kWayStep_mm = 2.0;
constexpr int kGasBelow_hu = -300;  ///< As in src/anatomy; gas in bowel is labelled bowel.
constexpr double kFacingSlab_mm = 8.0;

// Weights of what a place costs; assumed, chosen on the embedded patients and two CTs.
constexpr double kThroughCost = 0.7;  ///< A way that meets nothing of what it should pass.
constexpr double kShiftCost = 0.15;   ///< A place at the end of the search.
constexpr double kSlantCost = 2.0;    ///< A rad beyond kFreeSlant.
constexpr double kContactCost = 1.5;  ///< A face that touches nowhere.
constexpr double kDentCost = 0.04;    ///< A mm of the deepest dent beyond kFreeDent_mm.
constexpr double kFreeDent_mm = 9.0;

/// What a patient's voxels mean to a scanline.
struct Ground {
  const VirtualPatient& patient;
  std::array<bool, 256> is_bone{}, is_lung{}, is_through{};

  Ground(const VirtualPatient& p, const ProbeView& view) : patient(p) {
    for (const Label& label : p.label_table.labels) {
      is_bone[label.id] = label.tissue == "bone" || label.tissue == "cartilage";  // of ribs
      is_lung[label.id] = label.tissue == "lung" || label.tissue == "gas";
    }
    if (const Label* through = find_target(p, view.through)) is_through[through->id] = true;
  }

  double skin_mm(const Vec3& p_P) const { return sample_linear(patient.skin_distance_mm, p_P); }
  /// Outwards, unit.
  Vec3 skin_normal(const Vec3& p_P) const {
    Vec3 slope;
    for (int a = 0; a < 3; ++a) {
      const Vec3 step = kSlope_mm * Vec3::Unit(a);
      slope[a] = skin_mm(p_P + step) - skin_mm(p_P - step);
    }
    return slope.norm() > 1e-9 ? Vec3(slope.normalized()) : Vec3(0, -1, 0);
  }
  bool contains(const Vec3& p_P) const {
    const Vec3 index = patient.labels.geometry.to_index(p_P);
    const Index3& size = patient.labels.geometry.size;
    return (index.array() > -0.5).all() && index.x() < static_cast<double>(size[0]) - 0.5 &&
           index.y() < static_cast<double>(size[1]) - 0.5 && index.z() < static_cast<double>(size[2]) - 0.5;
  }
};

Vec3 voxel_place(const GridGeometry& geometry, std::size_t n) {
  const Index3 ijk = geometry.index_of(n);
  return geometry.to_mm(Vec3(static_cast<double>(ijk[0]), static_cast<double>(ijk[1]), static_cast<double>(ijk[2])));
}

/// Calls use(point) for every voxel of a label.
template <class Use>
void for_voxels(const LabelGrid& labels, std::uint8_t id, const Use& use) {
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (labels.voxels[n] == id) use(voxel_place(labels.geometry, n));
  }
}

Vec3 centroid(const LabelGrid& labels, std::uint8_t id) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for_voxels(labels, id, [&](const Vec3& p_P) {
    sum += p_P;
    count += 1.0;
  });
  return sum / count;
}

Vec3 nearest_voxel(const LabelGrid& labels, std::uint8_t id, const Vec3& to_P) {
  Vec3 best_P = to_P;
  double least = std::numeric_limits<double>::infinity();
  for_voxels(labels, id, [&](const Vec3& p_P) {
    const double squared = (p_P - to_P).squaredNorm();
    if (squared < least) {
      least = squared;
      best_P = p_P;
    }
  });
  return best_P;
}

/// Middle of the part of a label that lies nearest to a point.
Vec3 facing_point(const LabelGrid& labels, std::uint8_t id, const Vec3& from_P) {
  const double nearest_mm = (nearest_voxel(labels, id, from_P) - from_P).norm();
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for_voxels(labels, id, [&](const Vec3& p_P) {
    if ((p_P - from_P).norm() > nearest_mm + kFacingSlab_mm) return;
    sum += p_P;
    count += 1.0;
  });
  return nearest_voxel(labels, id, sum / count);
}

Result<Vec3> find_target_point(const VirtualPatient& patient, const ProbeView& view) {
  const Label* target = find_target(patient, view.targets);
  const Label* through = find_target(patient, view.through);
  if (target == nullptr || (view.point == TargetPoint::kFacing && through == nullptr))
    return fail_usage(fmt::format("the patient has nothing to see for the view \"{}\": no {}", view.name,
                                  fmt::join(target == nullptr ? view.targets : view.through, ", ")),
                      patient.name);
  const Vec3 p_P = view.point == TargetPoint::kFacing
                       ? facing_point(patient.labels, target->id, centroid(patient.labels, through->id))
                       : nearest_voxel(patient.labels, target->id, centroid(patient.labels, target->id));
  return Vec3(p_P + view.offset_mm);
}

/// First point of the skin on the way from a point inside; nothing where the way leaves the volume before.
std::optional<Vec3> skin_along(const Ground& ground, const Vec3& from_P, const Vec3& direction_P) {
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

/// The skin in the view's direction, else in one nearer to the shortest way out: a part of the body that is cut off, or
/// a block of tissue, has no skin at its sides.
std::optional<Vec3> find_skin(const Ground& ground, const Vec3& target_P, const Vec3& direction_P) {
  const Vec3 shortest = ground.skin_normal(target_P);
  for (const double share : {0.0, 0.5, 1.0}) {
    const Vec3 between = (1.0 - share) * direction_P + share * shortest;
    if (between.norm() < 1e-6) continue;
    if (const auto skin_P = skin_along(ground, target_P, between.normalized())) return skin_P;
  }
  return std::nullopt;
}

/// +x of T before it is made square to the beam.
Vec3 marker(const ProbeView& view, const Vec3& beam_P) {
  constexpr double kFromFlank = 0.8;  // cosine: the patient's right lies along the beam
  if (view.plane == ScanPlane::kLongitudinal) return Vec3::UnitZ();
  if (std::abs(beam_P.x()) < kFromFlank) return -Vec3::UnitX();
  return Vec3::UnitZ().cross(beam_P);
}

Mat3 orientation(const ProbeView& view, const Vec3& beam_P) {
  const Vec3 wish = marker(view, beam_P);
  Vec3 x = wish - wish.dot(beam_P) * beam_P;
  x = x.norm() > 1e-3 ? Vec3(x.normalized()) : Vec3(beam_P.unitOrthogonal());
  x = Eigen::AngleAxisd(view.angle_rad, beam_P) * x;
  Mat3 R_PT;
  R_PT << x, beam_P, x.cross(beam_P);
  return R_PT;
}

/// A place that has been tried.
struct Candidate {
  Pose X_PT;
  double cost = 0.0;
};

class Placer {
 public:
  Placer(const Ground& ground, const ProbeView& view, const Transducer& transducer, const Vec3& target_P)
      : ground_(ground),
        view_(view),
        scan_(make_scan_geometry(transducer, view.depth_mm, kLines, 16)),
        target_P_(target_P) {}

  Candidate place(const Vec3& skin_P, double shift_share) {
    const Vec3 beam_P = (target_P_ - skin_P).normalized();
    Candidate candidate;
    const FaceFit fit =
        fit_face(ground_.patient.skin_distance_mm, scan_, skin_P, orientation(view_, beam_P), view_.pressed_mm);
    candidate.X_PT = fit.X_PT;
    const double slant = std::acos(std::clamp(-ground_.skin_normal(skin_P).dot(candidate.X_PT.R().col(1)), -1.0, 1.0));
    candidate.cost = way_cost(candidate.X_PT) + kShiftCost * shift_share * shift_share +
                     kSlantCost * std::max(slant - kFreeSlant, 0.0) + kContactCost * (1.0 - fit.touching) +
                     kDentCost * std::max(fit.dent_mm - kFreeDent_mm, 0.0);
    return candidate;
  }

 private:
  /// What a scanline meets on its way to the target's depth.
  struct Way {
    double seen = 1.0;     ///< Share before bone or gas.
    double through = 0.0;  ///< Share in what it should pass.
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
      const auto label = sample_nearest<std::uint8_t>(ground_.patient.labels, p_P, 0);
      way.is_at_bone = ground_.is_bone[label];
      const bool is_gas = sample_nearest<std::int16_t>(ground_.patient.ct, p_P, 0) < kGasBelow_hu;
      if (way.is_at_bone || is_gas || ground_.is_lung[label] || !ground_.contains(p_P)) {
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
    std::array<double, 2> bone{};  // by side
    int in_side = 0;
    for (int n = 0; n < kLines; ++n) {
      const double off = (n - middle) / middle;  // -1..1
      const Way way = walk(X_PT, n, depth_mm);
      const double weight = std::exp(-0.5 * std::pow(off / middle_share(), 2));
      weights += weight;
      missed += weight * (1.0 - way.through);
      hidden += weight * (view_.bone == BoneWish::kShow ? 1.0 - (way.is_at_bone ? 1.0 : 0.0) : 1.0 - way.seen);
      if (off < -kSide) ++in_side;
      if (std::abs(off) > kSide && way.is_at_bone) bone[off < 0.0 ? 0 : 1] += 1.0;
    }
    double cost = hidden / weights;
    if (!view_.through.empty()) cost += kThroughCost * missed / weights;
    if (view_.bone == BoneWish::kBeside) {
      for (const double lines : bone) cost += 1.0 - std::min(lines / (kRibShare * in_side), 1.0);
    }
    return cost;
  }

  /// Standard deviation of the scanlines' weights, in halves of the width; between ribs only the middle is free.
  double middle_share() const { return view_.bone == BoneWish::kBeside ? 0.2 : 0.4; }
  static constexpr double kSide = 0.3;
  static constexpr double kRibShare = 0.3;  ///< Of a side's scanlines that a rib takes.

  const Ground& ground_;
  const ProbeView& view_;
  ScanGeometry scan_;
  Vec3 target_P_;
};

/// The point of the skin near a point.
Vec3 on_skin(const Ground& ground, Vec3 p_P) {
  for (int round = 0; round < 4; ++round) p_P -= ground.skin_mm(p_P) * ground.skin_normal(p_P);
  return p_P;
}

}  // namespace

Result<Pose> place_probe(const VirtualPatient& patient, const ProbeView& view, const Transducer& transducer) {
  if (patient.labels.empty()) return fail("the patient has no voxels", patient.name);
  TROCAR_TRY(const Vec3 target_P, find_target_point(patient, view));
  const Ground ground(patient, view);
  const std::optional<Vec3> skin_P = find_skin(ground, target_P, view.direction_P);
  if (!skin_P)
    return fail(fmt::format("no skin lies where the view \"{}\" looks from: the CT ends before it", view.name),
                patient.name, "choose another view");

  Placer placer(ground, view, transducer, target_P);
  const Mat3 R_PT = orientation(view, (target_P - *skin_P).normalized());
  const Vec3 normal = ground.skin_normal(*skin_P);
  const Vec3 along_x = (R_PT.col(0) - R_PT.col(0).dot(normal) * normal).normalized();
  const Vec3 along_z = normal.cross(along_x);
  Candidate best = placer.place(*skin_P, 0.0);
  const int steps = static_cast<int>(view.search_mm / kSearchStep_mm);
  for (int v = -steps; v <= steps; ++v) {
    for (int u = -steps; u <= steps; ++u) {
      const double shift_share = std::hypot(u, v) / std::max(steps, 1);
      if (shift_share > 1.0 || (u == 0 && v == 0)) continue;
      const Vec3 place_P = on_skin(ground, *skin_P + kSearchStep_mm * (u * along_x + v * along_z));
      if (!ground.contains(place_P)) continue;
      const Candidate candidate = placer.place(place_P, shift_share);
      if (candidate.cost < best.cost) best = candidate;
    }
  }
  return best.X_PT;
}

}  // namespace trocar
