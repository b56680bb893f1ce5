#include "registration/ct_ultrasound/detail/skin_starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/parallel.h"
#include "registration/ct_ultrasound/detail/pose_metric.h"
#include "registration/ct_ultrasound/detail/smoothing.h"
#include "volume/morphology.h"
#include "volume/sampling.h"

namespace trocar::registration::detail {
namespace {

/// docs/physics.md R14; all assumed.
constexpr float kBody_hu = -300.0F;
constexpr double kSkinSpacing_mm = 8.0;  ///< Of the grid on which the skin is found.
constexpr double kBetween_mm = 22.0;     ///< Distance between places on the skin.
constexpr int kRolls = 16;
constexpr double kTilt_rad = 0.3;
constexpr double kSearchSmoothing_mm = 4.0;  ///< Smoothing of the volumes.
constexpr std::size_t kFirstSamples = 2000, kRefinedSamples = 8000, kBodySamples = 150;
constexpr std::size_t kClimbed = 300, kRefinedPoses = 80, kFinal = 20;
constexpr double kLeastInBody = 0.9;  ///< Usable voxels show tissue, not air.

struct SkinPlace {
  Vec3 p_C;
  Vec3 inward_C;
};

/// The body on voxels of about kSkinSpacing_mm: 1 where it is not outside air.
volume::MaskGrid find_body(const volume::CtGrid& ct) {
  volume::Index3 factors{};
  for (std::size_t a = 0; a < 3; ++a)
    factors[a] = std::clamp<std::int64_t>(std::llround(kSkinSpacing_mm / ct.geometry.spacing_mm[static_cast<int>(a)]),
                                          1, ct.geometry.size[a]);
  const volume::FloatGrid means = block_means(ct, {0, 0, 0}, ct.geometry.size, factors);
  volume::MaskGrid body(means.geometry);
  for (std::size_t n = 0; n < body.voxels.size(); ++n) body.voxels[n] = means.voxels[n] > kBody_hu ? 1 : 0;
  return volume::fill_holes_in_slices(volume::largest_component(body));
}

/// Places about kBetween_mm apart on the border of the body, with the direction into it.
std::vector<SkinPlace> find_skin(const volume::MaskGrid& body) {
  volume::FloatGrid smooth_body(body.geometry);
  std::copy(body.voxels.begin(), body.voxels.end(), smooth_body.voxels.begin());
  smooth(smooth_body, 1.5 * kSkinSpacing_mm);
  std::vector<SkinPlace> places;
  const auto& size = body.geometry.size;
  for (std::size_t n = 0; n < body.voxels.size(); ++n) {
    const volume::Index3 ijk = body.geometry.index_of(n);
    if (body.voxels[n] == 0) continue;
    bool is_border = false;
    for (std::size_t a = 0; a < 3; ++a)
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 next = ijk;
        next[a] += step;
        is_border = is_border || (next[a] >= 0 && next[a] < size[a] && body[next] == 0);
      }
    const Vec3 p = body.geometry.centre_mm(ijk);
    if (!is_border || std::any_of(places.begin(), places.end(),
                                  [&](const SkinPlace& other) { return (other.p_C - p).norm() < kBetween_mm; }))
      continue;
    const Vec3 slope = volume::gradient_per_mm(smooth_body, p);
    if (slope.norm() > 1e-4) places.push_back({p, slope.normalized()});
  }
  return places;
}

struct SkinPose {
  Pose X_CU;
  double value = 0.0;
};

/// Poses with the middle of the face at a place on the skin.
std::vector<SkinPose> candidates_at(const std::vector<SkinPlace>& places, const Beams& beams, const Vec3& centre_U) {
  Beams::Place face = beams.to_place(centre_U);
  if (beams.is_fan()) face = {};
  face.depth_mm = 0.0;
  const Vec3 face_U = beams.to_point(face);
  const Vec3 beam_U = beams.direction(face_U);
  std::vector<SkinPose> candidates;
  for (const SkinPlace& place : places) {
    const Vec3 side = place.inward_C.unitOrthogonal();
    const Vec3 other = place.inward_C.cross(side);
    for (int tilt = 0; tilt < 5; ++tilt) {
      const double angle = 0.5 * std::numbers::pi * tilt;
      const Vec3 lean = tilt == 4 ? Vec3(Vec3::Zero()) : Vec3(std::cos(angle) * side + std::sin(angle) * other);
      const Vec3 inward = (place.inward_C + std::tan(kTilt_rad) * lean).normalized();
      const Mat3 upright = rotation_between(beam_U, inward);
      for (int roll = 0; roll < kRolls; ++roll) {
        const double turn = 2.0 * std::numbers::pi * roll / kRolls;
        const Mat3 R = Eigen::AngleAxisd(turn, inward).toRotationMatrix() * upright;
        candidates.push_back({Pose(R, place.p_C - R * face_U), 0.0});
      }
    }
  }
  return candidates;
}

/// Drops poses that put much of the ultrasound into air or beside the CT.
void keep_in_body(std::vector<SkinPose>& candidates, const volume::MaskGrid& body, const std::vector<Vec3>& points) {
  std::erase_if(candidates, [&](const SkinPose& candidate) {
    const auto inside = std::count_if(points.begin(), points.end(), [&](const Vec3& p) {
      return volume::sample_nearest(body, candidate.X_CU * p, std::uint8_t{0}) != 0;
    });
    return static_cast<double>(inside) < kLeastInBody * static_cast<double>(points.size());
  });
}

void keep_best(std::vector<SkinPose>& candidates, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const SkinPose& a, const SkinPose& b) { return a.value > b.value; });
  if (candidates.size() > most) candidates.resize(most);
}

/// Values of the candidates, or with options the tops of the climbs from them; in parallel.
/// `is_cancelled` is polled for each; the values are incomplete then.
void evaluate(std::vector<SkinPose>& candidates, const Level& level, const std::vector<Vec3>& points,
              const WorkingUltrasound& us, const std::optional<ClimbOptions>& options,
              const std::function<bool()>& is_cancelled) {
  constexpr std::size_t kGrain = 4;
  parallel_for(candidates.size(), kGrain, [&](std::size_t first, std::size_t last) {
    PoseMetric metric(level, points, us.centre);
    for (std::size_t n = first; n < last && !is_cancelled(); ++n) {
      const Motion motion = motion_of(candidates[n].X_CU, us.centre);
      if (!options) {
        candidates[n].value = metric.value(motion);
        continue;
      }
      const Summit summit = climb(metric, motion, *options);
      candidates[n] = {pose_of(summit.motion, us.centre), summit.value};
    }
  });
}

}  // namespace

Result<Pose> search_from_skin(const volume::CtGrid& ct, const WorkingUltrasound& us, const Beams& beams,
                              std::uint64_t seed, const std::function<bool()>& is_cancelled, const Progress& progress) {
  const volume::MaskGrid body = find_body(ct);
  std::vector<SkinPose> candidates = candidates_at(find_skin(body), beams, us.centre);
  const std::vector<Vec3> few_points = sample_usable(us, kBodySamples, seed);
  keep_in_body(candidates, body, few_points);
  if (candidates.empty())
    return fail("no place on the skin of the CT has room for the ultrasound", {},
                "give landmarks, or a CT of the region");
  constexpr double kWhole_mm = 1e4;
  const volume::FloatGrid ct_C = prepare_ct(ct, ct.geometry.to_mm(Vec3::Zero()), kWhole_mm);
  const Level coarse = make_level(us, ct_C, kSearchSmoothing_mm, kSearchSmoothing_mm, 2);
  const Level fine = make_level(us, ct_C, kUsFine_mm, kCtFine_mm, 1);
  /// Values of the candidates at a level, or climbs from them; the best are kept.
  struct Stage {
    const Level& level;
    std::size_t samples;
    std::optional<ClimbOptions> climb;
    std::size_t kept;
  };
  const Stage stages[] = {{coarse, kFirstSamples, {}, kClimbed},
                          {coarse, kFirstSamples, ClimbOptions{us.radius_mm, 5.0, 0.7, 30}, kRefinedPoses},
                          {coarse, kRefinedSamples, ClimbOptions{us.radius_mm, 2.0, 0.4, 30}, kFinal},
                          {fine, kRefinedSamples, ClimbOptions{us.radius_mm, 1.5, 0.2, 30}, 1}};
  double done = 0.2;
  for (const Stage& stage : stages) {
    report(progress, "searching from the skin", done);
    done += 0.2;
    evaluate(candidates, stage.level, sample_usable(us, stage.samples, seed), us, stage.climb, is_cancelled);
    if (is_cancelled()) return fail("the search was cancelled", {}, "start it again");
    if (stage.climb) keep_in_body(candidates, body, few_points);
    keep_best(candidates, stage.kept);
  }
  if (candidates.empty())
    return fail("no pose with the transducer on the skin matches", {}, "give landmarks, or a CT of the region");
  return candidates.front().X_CU;
}

}  // namespace trocar::registration::detail
