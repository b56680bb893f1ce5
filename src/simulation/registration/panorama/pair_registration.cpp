#include "registration/panorama/pair_registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/result.h"
#include "registration/intensity/gray_levels.h"
#include "volume/morphology.h"

namespace trocar::registration {
namespace {

constexpr std::size_t kMotionsOfThree = 40;
constexpr std::size_t kMotionsOfOne = 400;
constexpr std::size_t kAligned = 40;  ///< Motions that are aligned at the coarse detail, after all were at the widest.
constexpr std::size_t kAlignedMiddle = 12;  ///< Of those, that are aligned at the middle detail.
constexpr double kSameAtCorners_mm = 5.0;   ///< Motions nearer than this at the corners are one.

/// Significance of a correlation: the larger the overlap and the correlation, the larger. Speckle smoothed by sigma is
/// independent at points about 2 sqrt(pi) sigma apart.
double significance(const Alignment& alignment, const DetailLevel& level) {
  if (alignment.ncc <= 0.0) return 0.0;
  const double ncc = std::min(alignment.ncc, 0.9999);
  const double voxel_mm = level.values.geometry.spacing_mm.x();
  const double points = alignment.overlap * static_cast<double>(level.points.size());
  const double apart_mm = 2.0 * std::sqrt(std::numbers::pi) * level.sigma_mm;
  const double stride_mm = voxel_mm * std::cbrt(static_cast<double>(level.values.voxels.size()) /
                                                static_cast<double>(std::max<std::size_t>(level.points.size(), 1)));
  const double independent = points * std::min(1.0, std::pow(stride_mm / apart_mm, 3.0));
  return std::atanh(ncc) * std::sqrt(std::max(independent - 3.0, 0.0));
}

struct Candidate {
  Alignment alignment;
  double significance = 0.0;
};

void sort_best_first(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.significance > y.significance; });
}

std::vector<PointPair> point_pairs(const PreparedVolume& a, const PreparedVolume& b,
                                   const std::vector<Match>& matches) {
  std::vector<PointPair> pairs;
  for (const Match& m : matches) pairs.push_back({a.keypoints.keypoints[m.a].p_P, b.keypoints.keypoints[m.b].p_P});
  return pairs;
}

/// The motion that brings the places and orientations of a match together.
Pose motion_of(const PreparedVolume& a, const PreparedVolume& b, const Match& m) {
  const Mat3 R_AB =
      a.keypoints.features.features[m.feature_a].R_PK * b.keypoints.features.features[m.feature_b].R_PK.transpose();
  return {R_AB, a.keypoints.keypoints[m.a].p_P - R_AB * b.keypoints.keypoints[m.b].p_P};
}

/// Motions to try: of three matches, and of every keypoint with the nearest of the other volume, in both directions.
Result<std::vector<Pose>> propose(const PreparedVolume& a, const PreparedVolume& b, const std::vector<PointPair>& pairs,
                                  const PairOptions& options) {
  TROCAR_TRY(const std::vector<RigidMotion> motions,
             find_motions(pairs, std::max(a.extent_mm(), b.extent_mm()), options.ransac, kMotionsOfThree));
  std::vector<Pose> proposals;
  for (const RigidMotion& motion : motions) proposals.push_back(motion.X_AB);
  MatchOptions all = options.match;
  all.largest_ratio = 1.0;
  all.is_mutual = false;
  TROCAR_TRY(const std::vector<Match> of_a, match(a.keypoints, b.keypoints, all));
  TROCAR_TRY(const std::vector<Match> of_b, match(b.keypoints, a.keypoints, all));
  for (std::size_t n = 0; n < std::min(of_a.size(), kMotionsOfOne); ++n) proposals.push_back(motion_of(a, b, of_a[n]));
  for (std::size_t n = 0; n < std::min(of_b.size(), kMotionsOfOne); ++n)
    proposals.push_back(motion_of(b, a, of_b[n]).inverse());
  return proposals;
}

/// The largest distance between places of points of B after either motion.
double difference_mm(const PreparedVolume& b, const Pose& X, const Pose& Y) {
  double largest = 0.0;
  const auto& geometry = b.gray.geometry;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis) {
      const auto last = static_cast<double>(geometry.size[static_cast<std::size_t>(axis)] - 1);
      index[axis] = ((corner >> axis) & 1) != 0 ? 0.8 * last : 0.2 * last;
    }
    const Vec3 p = geometry.to_mm(index);
    largest = std::max(largest, (X * p - Y * p).norm());
  }
  return largest;
}

/// Keeps the best of motions that are about the same.
void remove_repeats(const PreparedVolume& b, std::vector<Candidate>& candidates) {
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates) {
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return difference_mm(b, c.alignment.X_AB, other.alignment.X_AB) > kSameAtCorners_mm;
    });
    if (is_new) kept.push_back(c);
  }
  candidates = std::move(kept);
}

std::vector<Candidate> align_at(const PreparedVolume& a, const PreparedVolume& b, std::size_t detail,
                                const std::vector<Pose>& poses) {
  std::vector<Candidate> candidates(poses.size());
  parallel_for(poses.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const DetailLevel& level = a.details[detail];
      candidates[n].alignment = align(level.points, b.details[detail].values, poses[n]);
      candidates[n].significance = significance(candidates[n].alignment, level);
    }
  });
  sort_best_first(candidates);
  remove_repeats(b, candidates);
  return candidates;
}

std::vector<Pose> best_poses(const std::vector<Candidate>& candidates, std::size_t most) {
  std::vector<Pose> poses;
  for (std::size_t n = 0; n < std::min(most, candidates.size()); ++n) poses.push_back(candidates[n].alignment.X_AB);
  return poses;
}

double logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// 0..1 from the significance of the best motion, and its distance to the best other one. Volumes of different places:
/// up to 15, less than 2 apart; half-overlapping volumes: 30 to 50, 13 or more apart (docs/validation.md).
double confidence_of_best(const std::vector<Candidate>& candidates) {
  if (candidates.empty()) return 0.0;
  constexpr double kSignificance = 17.0, kApart = 5.0, kWidth = 1.0;
  const double best = candidates.front().significance;
  const double other = candidates.size() > 1 ? candidates[1].significance : 0.0;
  return logistic((best - kSignificance) / kWidth) * logistic((best - other - kApart) / kWidth);
}

}  // namespace

Alignment refine_pair(const PreparedVolume& a, const PreparedVolume& b, const Pose& X_AB) {
  return align(a.details.back().points, b.details.back().values, X_AB);
}

Result<PairRegistration> register_pair(const PreparedVolume& a, const PreparedVolume& b, const PairOptions& options) {
  if (!(options.least_confidence >= 0.0 && options.least_confidence <= 1.0))
    return fail_usage("the least confidence is out of range", fmt::format("{:g}", options.least_confidence),
                      "give 0 to 1");
  PairRegistration result;
  TROCAR_TRY(result.matches, match(a.keypoints, b.keypoints, options.match));
  const std::vector<PointPair> pairs = point_pairs(a, b, result.matches);
  TROCAR_TRY(const std::vector<Pose> proposals, propose(a, b, pairs, options));
  const std::vector<Candidate> widest = align_at(a, b, 0, proposals);
  const std::vector<Candidate> coarse = align_at(a, b, 1, best_poses(widest, kAligned));
  const std::vector<Candidate> middle = align_at(a, b, 2, best_poses(coarse, kAlignedMiddle));
  result.confidence = confidence_of_best(middle);
  result.significance = middle.empty() ? 0.0 : middle.front().significance;
  if (middle.empty()) return result;
  const Alignment fine = refine_pair(a, b, middle.front().alignment.X_AB);
  result.X_AB = fine.X_AB;
  result.ncc = fine.ncc;
  result.overlap = fine.overlap;
  result.information = fine.information;
  result.middle_A = fine.middle_A;
  double squares = 0.0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const double apart_mm = (fine.X_AB * pairs[n].b - pairs[n].a).norm();
    if (apart_mm > options.ransac.inlier_mm) continue;
    result.inliers.push_back(n);
    squares += apart_mm * apart_mm;
  }
  if (!result.inliers.empty()) result.keypoint_rms_mm = std::sqrt(squares / static_cast<double>(result.inliers.size()));
  result.is_found = result.confidence >= options.least_confidence;
  return result;
}

namespace {

struct Detail {
  double sigma_voxels;
  int stride;
};
/// Wide maxima first, then accuracy.
constexpr std::array<Detail, 4> kDetails = {{{6.0, 9}, {4.0, 6}, {2.0, 3}, {1.0, 1}}};
constexpr std::size_t kLeastUsable = 1000;  ///< Voxels.

std::size_t count_usable(const volume::MaskGrid& usable) {
  std::size_t count = 0;
  for (const std::uint8_t v : usable.voxels) count += v;
  return count;
}

Result<double> threshold_of(const PreparedVolume& volume, const PreparationOptions& options) {
  if (options.shadow_threshold) return *options.shadow_threshold;
  const volume::MaskGrid inside = imaged_voxels(volume.gray, volume.beams);
  return estimate_shadow_threshold(std::span(&volume.gray, 1), std::span(&inside, 1));
}

/// Voxels for the comparison of gray levels: away from shadows, and not in the near part of a fan.
volume::MaskGrid comparable_voxels(const PreparedVolume& volume, const PreparationOptions& options, double voxel_mm) {
  volume::MaskGrid usable = volume.region.usable;
  if (volume.beams.is_fan()) {
    for (std::size_t n = 0; n < usable.voxels.size(); ++n) {
      if (usable.voxels[n] == 0) continue;
      const Vec3 p = usable.geometry.centre_mm(usable.geometry.index_of(n));
      if (volume.beams.to_place(p).depth_mm < options.near_part_mm) usable.voxels[n] = 0;
    }
  }
  return volume::erode(usable, options.widening_voxels * voxel_mm);
}

/// Smoothed gray levels for comparisons.
void add_details(PreparedVolume& volume, const volume::FloatGrid& flat, const PreparationOptions& options) {
  const double spacing_mm = options.scale_space.spacing_mm;
  const double voxel_mm = spacing_mm > 0.0 ? spacing_mm : std::cbrt(volume.gray.geometry.voxel_volume_mm3());
  const volume::MaskGrid narrowed = comparable_voxels(volume, options, voxel_mm);
  for (const Detail& detail : kDetails) {
    DetailLevel level;
    level.sigma_mm = detail.sigma_voxels * voxel_mm;
    level.values = smooth_usable(flat, narrowed, level.sigma_mm);
    level.points = alignment_points(level.values, detail.stride);
    volume.details.push_back(std::move(level));
  }
}

Status prepare_steps(PreparedVolume& volume, const PreparationOptions& options, const Progress& progress) {
  if (!(options.widening_voxels >= 0.0 && options.widening_voxels <= 20.0))
    return fail_usage("the widening of shadows is out of range", fmt::format("{:g}", options.widening_voxels),
                      "give 0 to 20 voxels");
  if (!(options.near_part_mm >= 0.0 && options.near_part_mm <= 200.0))
    return fail_usage("the near part is out of range", fmt::format("{:g}", options.near_part_mm), "give 0 to 200 mm");
  report(progress, "finding shadows", 0.0);
  TROCAR_TRY(volume.shadow_threshold, threshold_of(volume, options));
  TROCAR_TRY(volume.region, find_shadows(volume.gray, volume.beams, volume.shadow_threshold));
  if (count_usable(volume.region.usable) < kLeastUsable)
    return fail("nearly all voxels are in shadow or outside of the fan", {},
                "check the beam axis and the shadow threshold");
  report(progress, "finding keypoints", 0.1);
  TROCAR_TRY(const volume::FloatGrid flat, flatten(volume.gray, volume.region.usable));
  TROCAR_TRY(const ScaleSpace space, build_scale_space(flat, volume.region.usable, options.scale_space));
  TROCAR_TRY(volume.keypoints.keypoints, find_keypoints(space, options.keypoints));
  report(progress, "describing keypoints", 0.3);
  TROCAR_TRY(volume.keypoints.features, describe(space, volume.keypoints.keypoints, options.descriptors));
  volume.keypoints.gray = gray_histograms(volume.gray, volume.region.usable, volume.keypoints.keypoints);
  report(progress, "smoothing", 0.8);
  add_details(volume, flat, options);
  return {};
}

}  // namespace

double PreparedVolume::extent_mm() const noexcept {
  return std::cbrt(static_cast<double>(count_usable(region.usable)) * gray.geometry.voxel_volume_mm3());
}

Result<PreparedVolume> prepare(std::string name, volume::LabelGrid gray, const Beams& beams,
                               const PreparationOptions& options, const Progress& progress) {
  PreparedVolume volume;
  volume.name = std::move(name);
  volume.gray = std::move(gray);
  volume.beams = beams;
  if (Status done = prepare_steps(volume, options, progress); !done)
    return fail_at(volume.name, std::move(done).error());
  report(progress, "done", 1.0);
  return volume;
}

}  // namespace trocar::registration
