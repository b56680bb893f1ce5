#include "registration/ct_ultrasound/detail/skin_starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
constexpr double kCoarse_mm = 4.0;  ///< Smoothing of the volumes.
constexpr std::size_t kSamples = 2000;
constexpr std::size_t kClimbed = 64, kFinal = 8;

struct SkinPlace {
  Vec3 p_C;
  Vec3 inward_C;
};

/// Places about kBetween_mm apart on the border of the largest body, with the direction of rising HU.
std::vector<SkinPlace> find_skin(const volume::CtGrid& ct) {
  volume::Index3 factors{};
  for (std::size_t a = 0; a < 3; ++a)
    factors[a] = std::clamp<std::int64_t>(std::llround(kSkinSpacing_mm / ct.geometry.spacing_mm[static_cast<int>(a)]),
                                          1, ct.geometry.size[a]);
  volume::FloatGrid means = block_means(ct, {0, 0, 0}, ct.geometry.size, factors);
  volume::MaskGrid air(means.geometry);
  for (std::size_t n = 0; n < air.voxels.size(); ++n) air.voxels[n] = means.voxels[n] < kBody_hu ? 1 : 0;
  const volume::MaskGrid outside = volume::largest_component(air);
  volume::FloatGrid body(means.geometry);
  for (std::size_t n = 0; n < body.voxels.size(); ++n) body.voxels[n] = outside.voxels[n] != 0 ? 0.0F : 1.0F;
  volume::FloatGrid smooth_body = body;
  smooth(smooth_body, 1.5 * kSkinSpacing_mm);
  std::vector<SkinPlace> places;
  const auto& size = body.geometry.size;
  for (std::size_t n = 0; n < body.voxels.size(); ++n) {
    const volume::Index3 ijk = body.geometry.index_of(n);
    if (body.voxels[n] == 0.0F || smooth_body.voxels[n] > 0.75F) continue;
    bool is_rim = false;
    for (std::size_t a = 0; a < 3; ++a) is_rim = is_rim || ijk[a] == 0 || ijk[a] == size[a] - 1;
    if (is_rim) continue;
    const Vec3 p = body.geometry.centre_mm(ijk);
    if (std::any_of(places.begin(), places.end(),
                    [&](const SkinPlace& other) { return (other.p_C - p).norm() < kBetween_mm; }))
      continue;
    const Vec3 slope = volume::gradient_per_mm(smooth_body, p);
    if (slope.norm() > 1e-4) places.push_back({p, slope.normalized()});
  }
  return places;
}

struct Candidate {
  Pose X_CU;
  double value = 0.0;
};

/// Poses with the middle of the face at a place on the skin.
std::vector<Candidate> candidates_at(const std::vector<SkinPlace>& places, const Beams& beams) {
  const Vec3 face_U = beams.to_point(beams.is_fan() ? Beams::Place{} : Beams::Place{});
  const Vec3 beam_U = beams.direction(face_U);
  std::vector<Candidate> candidates;
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

void keep_best(std::vector<Candidate>& candidates, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value > b.value; });
  if (candidates.size() > most) candidates.resize(most);
}

}  // namespace

Result<Pose> search_from_skin(const volume::CtGrid& ct, const WorkingUltrasound& us, const Beams& beams,
                              std::uint64_t seed) {
  std::vector<Candidate> candidates = candidates_at(find_skin(ct), beams);
  if (candidates.empty()) return fail("the CT shows no skin to search from", {}, "give --landmarks");
  const Vec3 whole = Vec3::Constant(1e4);
  volume::FloatGrid ct_C = prepare_ct(ct, ct.geometry.to_mm(Vec3::Zero()), whole.x());
  // ITK's Euler angles cover all rotations, so that one metric serves all candidates; only climbs start afresh.
  const Level level = make_level(us, ct_C, kCoarse_mm, kCoarse_mm, 2);
  const std::vector<Vec3> points = sample_usable(us, kSamples, seed);
  const auto evaluate = [&](bool is_climb) {
    const auto some = [&](std::size_t first) {
      PoseMetric metric(level, points, us.centre);
      for (std::size_t n = first; n < candidates.size(); n += 2) {
        Motion motion = motion_of(candidates[n].X_CU, us.centre);
        if (is_climb) {
          const Summit summit = climb(metric, motion, {us.radius_mm, 5.0, 0.7, 30});
          candidates[n] = {pose_of(summit.motion, us.centre), summit.value};
        } else {
          candidates[n].value = metric.value(motion);
        }
      }
    };
    parallel_invoke([&] { some(0); }, [&] { some(1); });
  };
  evaluate(false);
  keep_best(candidates, kClimbed);
  evaluate(true);
  keep_best(candidates, kFinal);
  return candidates.front().X_CU;
}

}  // namespace trocar::registration::detail
