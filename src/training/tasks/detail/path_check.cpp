#include "tasks/detail/path_check.h"

#include <algorithm>
#include <cmath>

#include "tasks/detail/block_grid.h"
#include "volume/sampling.h"

namespace trocar::tasks::detail {
namespace {

constexpr double kBorder_mm = 3.0;        ///< An entry this close to the volume's border may be on a cut face.
constexpr double kNormalRadius_mm = 3.0;  ///< Averaging distance of the skin's normal: voxels form steps.
constexpr double kScreenStep_mm = 2.0;
constexpr double kWalkStep_mm = 0.25;
constexpr double kSkinTolerance_mm = 0.5;  ///< Above the skin: still a fold of it, not outside the body.
constexpr double kMinMuscle_mm = 2.0;

bool is_near_border(const volume::GridGeometry& geometry, const Vec3& p_P, double margin_mm) {
  const Vec3 index = geometry.to_index(p_P);
  for (int a = 0; a < 3; ++a) {
    const double margin = margin_mm / geometry.spacing_mm[a];
    if (index[a] < margin || index[a] > static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1) - margin)
      return true;
  }
  return false;
}

/// Distance along `outward` to the skin; negative: not found before `reach_mm` or the volume's end.
double distance_to_skin(const volume::FloatGrid& skin_distance, const Vec3& start_P, const Vec3& outward,
                        double reach_mm, PathVerdict& verdict) {
  double s = 0.0;
  double inside = 0.0;
  while (true) {
    const Vec3 p = start_P + s * outward;
    if (is_near_border(skin_distance.geometry, p, 0.0)) {
      verdict = PathVerdict::kCutFace;
      return -1.0;
    }
    const double distance = sample_linear(skin_distance, p);
    if (distance >= 0.0) break;
    if (s > reach_mm) {
      verdict = PathVerdict::kTooLong;
      return -1.0;
    }
    inside = s;
    s += std::max(-distance, kSkinTolerance_mm);  // no surface is nearer than the distance
  }
  for (int n = 0; n < 20; ++n) {
    const double middle = 0.5 * (inside + s);
    (sample_linear(skin_distance, start_P + middle * outward) < 0.0 ? inside : s) = middle;
  }
  return s;
}

/// Finds the nearest risk voxel around one piece of the path; `findings` keeps the smallest clearance. Stops at the
/// first violated margin.
void look_around(const PlanningMap& map, const Segment& piece, PathFindings& findings) {
  const volume::GridGeometry& geometry = map.patient.labels.geometry;
  const double half_voxel = 0.5 * geometry.spacing_mm.norm();
  const double radius = map.largest_margin_mm + findings.spare_margin_mm + half_voxel;
  const IndexBox box =
      clipped(united(box_around(geometry, piece.a, radius), box_around(geometry, piece.b, radius)), geometry);
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
        const std::uint8_t id = map.patient.labels[{i, j, k}];
        const RiskStructure* risk = map.risks[id];
        if (!risk) continue;
        const Vec3 centre = geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        if (distance_mm(piece, centre) - half_voxel - risk->margin_mm > findings.spare_margin_mm) continue;
        const double clearance = segment_box_distance_mm(piece, geometry, centre) - risk->margin_mm;
        if (clearance > findings.spare_margin_mm) continue;
        findings.spare_margin_mm = clearance;
        findings.nearest_risk = id;
        findings.where_P = centre;
        if (clearance < 0.0) return;
      }
}

/// Upper limit of the error of an interpolated coarse clearance: half a cell for the interpolation, and half a cell for
/// the position of the voxel within its cell.
double coarse_error_mm(const PlanningMap& map) {
  return 2.0 * map.slack_mm;
}

/// Exact clearance of the whole path: pieces in order of their coarse clearance, until none can be nearer.
void measure_margins(const PlanningMap& map, const Segment& way, PathFindings& findings) {
  const int count = static_cast<int>(std::ceil(way.length_mm() / kChunk_mm));
  const double error = coarse_error_mm(map);
  findings.spare_margin_mm = kReportedMargin_mm;
  std::vector<std::pair<double, Segment>> pieces;
  for (int n = 0; n < count; ++n) {
    const Segment piece{way.at(static_cast<double>(n) / count), way.at(static_cast<double>(n + 1) / count)};
    const double coarse = sample_linear(map.clearance_mm, piece.at(0.5));
    pieces.emplace_back(coarse - 0.5 * piece.length_mm() - error, piece);
    findings.spare_margin_mm = std::min(findings.spare_margin_mm, std::max(0.0, coarse + error));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [bound, piece] : pieces) {
    if (bound > findings.spare_margin_mm) break;
    look_around(map, piece, findings);
    if (findings.spare_margin_mm < 0.0) {
      findings.verdict = PathVerdict::kMargin;
      return;
    }
  }
}

/// Lengths along the path from the skin to the end of the throw.
class Walk {
 public:
  Walk(const PlanningMap& map, double tip_mm) : map_(map), tip_mm_(tip_mm) {}

  /// One step of the needle at arc length s; false ends the walk.
  bool step(double s, const Vec3& p_P) {
    const Role role = map_.role_at(p_P);
    if (role == Role::kForbidden) return stop(PathVerdict::kCrosses, p_P);
    const bool is_organ = role == Role::kOrgan || role == Role::kTarget;
    has_organ_ |= is_organ;
    if (!has_organ_ && role == Role::kMuscle) muscle_mm_ += kWalkStep_mm;
    if (has_organ_ && !is_organ) outside_mm_ += kWalkStep_mm;
    has_target_ |= role == Role::kTarget;
    if (role == Role::kOrgan && !has_target_ && s < tip_mm_) organ_mm_ += kWalkStep_mm;
    // Oblique voxel borders may contain the organ's surface twice within a voxel.
    if (outside_mm_ > map_.patient.labels.geometry.spacing_mm.norm()) return stop(PathVerdict::kLeavesOrgan, p_P);
    if (s > 1.0 && sample_linear(map_.patient.skin_distance_mm, p_P) > kSkinTolerance_mm)
      return stop(PathVerdict::kGlancing, p_P);
    return true;
  }

  PathFindings finish() const {
    PathFindings findings;
    findings.organ_path_mm = organ_mm_;
    findings.verdict = verdict_;
    findings.where_P = where_P_;
    if (verdict_ != PathVerdict::kFree) return findings;
    if (muscle_mm_ < kMinMuscle_mm) findings.verdict = PathVerdict::kNoMuscle;
    if (organ_mm_ < map_.task.min_organ_path_mm) findings.verdict = PathVerdict::kOrganPath;
    return findings;
  }

 private:
  bool stop(PathVerdict verdict, const Vec3& p_P) {
    verdict_ = verdict;
    where_P_ = p_P;
    return false;
  }

  const PlanningMap& map_;
  double tip_mm_;
  double muscle_mm_ = 0.0;
  double organ_mm_ = 0.0;
  double outside_mm_ = 0.0;
  bool has_organ_ = false;
  bool has_target_ = false;
  PathVerdict verdict_ = PathVerdict::kFree;
  Vec3 where_P_ = Vec3::Zero();
};

}  // namespace

Vec3 skin_normal(const volume::FloatGrid& skin_distance, const Vec3& p_P) {
  Vec3 slope;
  for (int a = 0; a < 3; ++a) {
    Vec3 step = Vec3::Zero();
    step[a] = kNormalRadius_mm;
    slope[a] = sample_linear(skin_distance, p_P + step) - sample_linear(skin_distance, p_P - step);
  }
  return slope.norm() > 0.0 ? Vec3(slope.normalized()) : Vec3::Zero();
}

double segment_box_distance_mm(const Segment& segment, const volume::GridGeometry& geometry, const Vec3& centre_P) {
  // Alternating projections converge fast at this size.
  const Vec3 half = 0.5 * geometry.spacing_mm;
  Vec3 on_box = centre_P;
  Vec3 on_segment = centre_P;
  for (int n = 0; n < 3; ++n) {
    on_segment = segment.at(closest_fraction(segment, on_box));
    const Vec3 local = geometry.R_PV.transpose() * (on_segment - centre_P);
    on_box = centre_P + geometry.R_PV * local.cwiseMax(-half).cwiseMin(half);
  }
  return (on_segment - on_box).norm();
}

PathCandidate trace_path(const PlanningMap& map, const Needle& needle, const Vec3& target_P, const Vec3& outward) {
  const volume::FloatGrid& skin_distance = map.patient.skin_distance_mm;
  PathCandidate path;
  const double ahead = needle.notch_middle_mm();
  const double longest = std::min(map.task.max_path_mm, needle.length_mm - kHubReserve_mm);
  const double to_skin = distance_to_skin(skin_distance, target_P, outward, longest + ahead, path.verdict);
  if (to_skin < 0.0) return path;
  path.line_P = {target_P + to_skin * outward, target_P + ahead * outward};
  path.length_mm = to_skin - ahead;
  const auto reject = [&](PathVerdict verdict) {
    path.verdict = verdict;
    return path;
  };
  if (path.length_mm > longest) return reject(PathVerdict::kTooLong);
  if (path.length_mm < map.task.min_organ_path_mm + kMinMuscle_mm) return reject(PathVerdict::kOrganPath);
  if (is_near_border(skin_distance.geometry, path.line_P.a, kBorder_mm)) return reject(PathVerdict::kCutFace);
  if (map.task.entry_zone && map.task.entry_zone->distance_outside_mm(path.line_P.a) > 0.0)
    return reject(PathVerdict::kOutsideZone);
  const Vec3 normal = skin_normal(skin_distance, path.line_P.a);
  const double down = normal.dot(anatomy::gravity_P(map.posture));
  if (down > std::sin(map.task.max_posterior_deg * kRadPerDeg)) return reject(PathVerdict::kOutOfReach);
  if (normal.dot(outward) < std::cos(map.task.max_entry_angle_deg * kRadPerDeg)) return reject(PathVerdict::kGlancing);

  const double whole = path.length_mm + needle.throw_mm;
  double smallest_mm = kReportedMargin_mm;
  for (double s = 0.0; s <= whole; s += kScreenStep_mm) {
    const Vec3 p = path.line_P.a - s * outward;
    path.where_P = p;
    if (map.role_at(p) == Role::kForbidden) return reject(PathVerdict::kCrosses);
    const double coarse_mm = sample_linear(map.clearance_mm, p);
    if (coarse_mm < -map.slack_mm) return reject(PathVerdict::kMargin);
    smallest_mm = std::min(smallest_mm, coarse_mm + coarse_error_mm(map));
  }
  path.largest_margin_mm = std::max(0.0, smallest_mm);
  return path;
}

PathFindings check_path(const PlanningMap& map, const Needle& needle, const PathCandidate& path) {
  const Vec3 axis = path.line_P.direction();
  const double whole = path.length_mm + needle.throw_mm;
  Walk walk(map, path.length_mm);
  const int steps = static_cast<int>(std::floor(whole / kWalkStep_mm));
  for (int n = 0; n <= steps; ++n)
    if (const double s = n * kWalkStep_mm; !walk.step(s, path.line_P.a + s * axis)) break;
  PathFindings findings = walk.finish();
  if (findings.verdict == PathVerdict::kFree)
    measure_margins(map, {path.line_P.a, path.line_P.a + whole * axis}, findings);
  return findings;
}

}  // namespace trocar::tasks::detail
