#include "registration/ct_ultrasound/rigid_registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "registration/ct_ultrasound/detail/pose_metric.h"
#include "registration/ct_ultrasound/detail/skin_starts.h"

namespace trocar::registration {
namespace {
using detail::Motion;
using detail::Summit;

/// docs/physics.md R12; all assumed, chosen on simulated sweeps.
constexpr std::size_t kCoarseSamples = 5000, kMiddleSamples = 10000, kFineSamples = 40000, kFinestSamples = 100000;
constexpr double kCoarse_mm = 3.5;  ///< Smoothing.
constexpr int kFewStarts = 5;       ///< Enough if most of them agree.
constexpr double kEnoughAgreement = 0.75;
constexpr int kStarts = 15;                                ///< The first estimate and displaced ones.
constexpr double kStartSpread_mm = 8.0;                    ///< Displacement of starts, by translation and by rotation.
constexpr std::size_t kRefined = 8, kRefinedIfAgreed = 2;  ///< Coarse summits that the next level refines.
constexpr double kSame_mm = 2.5;                           ///< Summits this near are one.
constexpr double kLeastOverlap = 0.3;
constexpr int kDisplaced = 48;                     ///< Poses that the metric is compared with.
constexpr double kAgreementWeight = 1.2;           ///< Against the distinction.
constexpr double kDoubtful = 3.2, kCertain = 9.2;  ///< Their sum at confidence 0 and 1.
constexpr double kDisplacedNear_mm = 15.0, kDisplacedFar_mm = 30.0;
constexpr std::uint64_t kCoarseSeed = 11, kMiddleSeed = 12, kFineSeed = 13, kStartSeed = 14, kDisplacedSeed = 15,
                        kFinestSeed = 16;

/// Volumes and samples of one registration.
struct Work {
  detail::WorkingUltrasound us;
  volume::FloatGrid ct_U;  ///< CT in the frame of the ultrasound at the first estimate.
  detail::Level coarse, fine;
  std::vector<Vec3> coarse_points, middle_points, fine_points, finest_points;
  std::vector<Vec3> probes;  ///< Some usable points: distances between motions are means over them.

  Pose pose(const Motion& motion) const { return detail::pose_of(motion, us.centre); }
  double distance_mm(const Motion& a, const Motion& b) const {
    const Pose first = pose(a), second = pose(b);
    double sum = 0.0;
    for (const Vec3& p : probes) sum += (first * p - second * p).norm();
    return sum / static_cast<double>(probes.size());
  }
};

volume::FloatGrid in_ultrasound(volume::FloatGrid ct, const Pose& X_CU) {
  const Pose X_UC = X_CU.inverse();
  ct.geometry.origin_P = X_UC * ct.geometry.origin_P;
  ct.geometry.R_PV = X_UC.R() * ct.geometry.R_PV;
  return ct;
}

double overlap_of(const volume::GridGeometry& ct_C, const std::vector<Vec3>& points_U, const Pose& X_CU) {
  std::size_t inside = 0;
  for (const Vec3& p : points_U) {
    const Vec3 index = ct_C.to_index(X_CU * p);
    bool is_inside = true;
    for (int a = 0; a < 3; ++a)
      is_inside = is_inside && index[a] >= -0.5 &&
                  index[a] <= static_cast<double>(ct_C.size[static_cast<std::size_t>(a)]) - 0.5;
    inside += is_inside ? 1 : 0;
  }
  return static_cast<double>(inside) / static_cast<double>(points_U.size());
}

/// A motion of about `distance_mm` over the samples: a translation and a rotation in random directions.
Motion random_motion(Random& random, double translation_mm, double rotation_mm, double radius_mm) {
  const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
  const Vec3 direction = Vec3(random.normal(), random.normal(), random.normal()).normalized();
  Motion motion;
  motion << rotation_mm / radius_mm * axis, translation_mm * direction;
  return motion;
}

std::vector<Motion> starts_near(const Motion& centre, double radius_mm, std::uint64_t seed) {
  Random random(seed ^ kStartSeed);
  std::vector<Motion> starts{centre};
  while (starts.size() < static_cast<std::size_t>(kStarts))
    starts.push_back(centre + random_motion(random, kStartSpread_mm, kStartSpread_mm, radius_mm));
  return starts;
}

/// Climbs from all starts, in parallel.
std::vector<Summit> climb_all(const detail::Level& level, const std::vector<Vec3>& points, const Work& work,
                              const std::vector<Motion>& starts, const detail::ClimbOptions& options) {
  std::vector<Summit> summits(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t first, std::size_t last) {
    detail::PoseMetric metric(level, points, work.us.centre);
    for (std::size_t n = first; n < last; ++n) summits[n] = detail::climb(metric, starts[n], options);
  });
  return summits;
}

/// The best summits, each at least kSame_mm from better ones.
std::vector<Summit> best_distinct(std::vector<Summit> summits, const Work& work, std::size_t most) {
  std::stable_sort(summits.begin(), summits.end(), [](const Summit& a, const Summit& b) { return a.value > b.value; });
  std::vector<Summit> best;
  for (const Summit& summit : summits) {
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const Summit& other) {
      return work.distance_mm(summit.motion, other.motion) < kSame_mm;
    });
    if (is_new && best.size() < most) best.push_back(summit);
  }
  return best;
}

/// Share of the summits at `motion`.
double agreement_at(const Motion& motion, const std::vector<Summit>& summits, const Work& work) {
  const auto near = std::count_if(summits.begin(), summits.end(), [&](const Summit& other) {
    return work.distance_mm(other.motion, motion) < 2.0 * kSame_mm;
  });
  return static_cast<double>(near) / static_cast<double>(summits.size());
}

/// Summits of the coarse level, from few starts if those agree.
std::vector<Summit> coarse_summits(const Work& work, const detail::ClimbOptions& options, std::uint64_t seed) {
  std::vector<Motion> starts = starts_near(Motion::Zero(), work.us.radius_mm, seed);
  const std::vector<Motion> others(starts.begin() + kFewStarts, starts.end());
  starts.resize(kFewStarts);
  std::vector<Summit> summits = climb_all(work.coarse, work.coarse_points, work, starts, options);
  const Summit best = best_distinct(summits, work, 1).front();
  if (agreement_at(best.motion, summits, work) >= kEnoughAgreement) return summits;
  const std::vector<Summit> more = climb_all(work.coarse, work.coarse_points, work, others, options);
  summits.insert(summits.end(), more.begin(), more.end());
  return summits;
}

/// The top of the fine level from a motion near it.
Summit refine_summit(const Work& work, const Motion& start) {
  detail::PoseMetric fine(work.fine, work.fine_points, work.us.centre);
  const Summit near = detail::climb(fine, start, {work.us.radius_mm, 0.4, 0.08, 30});
  detail::PoseMetric finest(work.fine, work.finest_points, work.us.centre);
  return detail::climb(finest, near.motion, {work.us.radius_mm, 0.1, 0.02, 15});
}

std::vector<Motion> motions_of(const std::vector<Summit>& summits) {
  std::vector<Motion> motions;
  for (const Summit& summit : summits) motions.push_back(summit.motion);
  return motions;
}

/// R13: deviations of the summit's value from those of displaced poses.
double distinction_of(detail::PoseMetric& metric, const Work& work, const Summit& summit, std::uint64_t seed) {
  Random random(seed ^ kDisplacedSeed);
  double sum = 0.0, squares = 0.0;
  for (int n = 0; n < kDisplaced; ++n) {
    const double share = random.uniform();
    const double far_mm = random.uniform(kDisplacedNear_mm, kDisplacedFar_mm);
    const double value =
        metric.value(summit.motion + random_motion(random, share * far_mm, (1.0 - share) * far_mm, work.us.radius_mm));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kDisplaced;
  const double deviation = std::sqrt(std::max(squares / kDisplaced - mean * mean, 1e-12));
  return (metric.value(summit.motion) - mean) / deviation;
}

tl::unexpected<Error> cancellation() {
  return fail("the registration was cancelled", {}, "start it again");
}

double ramp(double value, double low, double high) {
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

Work make_work(detail::WorkingUltrasound us, const volume::FloatGrid& ct_U, std::uint64_t seed) {
  Work work;
  work.us = std::move(us);
  work.ct_U = ct_U;
  work.coarse = detail::make_level(work.us, ct_U, kCoarse_mm, kCoarse_mm, 2);
  work.fine = detail::make_level(work.us, ct_U, detail::kUsFine_mm, detail::kCtFine_mm, 1);
  work.coarse_points = detail::sample_usable(work.us, kCoarseSamples, seed ^ kCoarseSeed);
  work.middle_points = detail::sample_usable(work.us, kMiddleSamples, seed ^ kMiddleSeed);
  work.fine_points = detail::sample_usable(work.us, kFineSamples, seed ^ kFineSeed);
  work.finest_points = detail::sample_usable(work.us, kFinestSamples, seed ^ kFinestSeed);
  work.probes = detail::sample_usable(work.us, 300, seed);
  return work;
}

}  // namespace

Result<RigidRegistration> register_rigid(const volume::CtGrid& ct, const volume::LabelGrid& us, const Beams& beams,
                                         const RigidOptions& options, const Progress& progress) {
  const std::function<bool()> cancelled = [&] { return options.is_cancelled && options.is_cancelled(); };
  report(progress, "preparing the volumes", 0.0);
  TROCAR_TRY(detail::WorkingUltrasound prepared, detail::prepare_ultrasound(us, beams));
  const std::vector<Vec3> probes = detail::sample_usable(prepared, 1000, options.seed);
  Pose X_CU = options.X_CU;
  if (options.is_search) {
    TROCAR_TRY(X_CU,
               detail::search_from_skin(ct, prepared, beams, options.seed, cancelled, part_of(progress, 0.1, 0.3)));
  } else if (overlap_of(ct.geometry, probes, X_CU) < kLeastOverlap) {
    return fail("the ultrasound and the CT do not overlap at the start", {},
                "give landmarks, or search from the skin if the headers do not share a frame");
  }
  if (cancelled()) return cancellation();
  const volume::FloatGrid ct_C = detail::prepare_ct(ct, X_CU * prepared.centre, prepared.radius_mm);
  const Work work = make_work(std::move(prepared), in_ultrasound(ct_C, X_CU), options.seed);
  if (cancelled()) return cancellation();

  report(progress, "coarse registration", 0.3);
  detail::ClimbOptions climb{work.us.radius_mm, 4.0, 0.4, 40};
  const std::vector<Summit> coarse = coarse_summits(work, climb, options.seed);
  if (cancelled()) return cancellation();
  report(progress, "refining", 0.6);
  const std::size_t refined = coarse.size() == static_cast<std::size_t>(kFewStarts) ? kRefinedIfAgreed : kRefined;
  climb = {work.us.radius_mm, 1.5, 0.1, 30};
  std::vector<Summit> middle =
      climb_all(work.fine, work.middle_points, work, motions_of(best_distinct(coarse, work, refined)), climb);
  std::erase_if(middle, [&](const Summit& summit) {
    return !options.is_search && work.distance_mm(summit.motion, Motion::Zero()) > options.reach_mm;
  });
  if (middle.empty())
    return fail(fmt::format("no pose within {:g} mm of the start matches", options.reach_mm), {},
                "give landmarks, or search from the skin");
  if (cancelled()) return cancellation();
  const Summit summit = refine_summit(work, best_distinct(middle, work, 1).front().motion);
  report(progress, "checking the result", 0.9);
  RigidRegistration result;
  result.X_CU = X_CU * work.pose(summit.motion);
  result.metric = summit.value;
  result.overlap = overlap_of(ct.geometry, probes, result.X_CU);
  result.shadow_share = work.us.shadow_share;
  detail::PoseMetric middle_metric(work.fine, work.middle_points, work.us.centre);
  result.distinction = distinction_of(middle_metric, work, summit, options.seed);
  result.agreement = agreement_at(summit.motion, coarse, work);
  result.confidence = ramp(result.distinction + kAgreementWeight * result.agreement, kDoubtful, kCertain);
  if (result.overlap < kLeastOverlap) result.confidence = 0.0;
  report(progress, "done", 1.0);
  return result;
}

Result<double> mean_distance_mm(const volume::LabelGrid& us, const Beams& beams, const Pose& X_a, const Pose& X_b) {
  TROCAR_TRY(const detail::WorkingUltrasound prepared, detail::prepare_ultrasound(us, beams));
  const std::vector<Vec3> points = detail::sample_usable(prepared, 2000, 1);
  double sum = 0.0;
  for (const Vec3& p : points) sum += (X_a * p - X_b * p).norm();
  return sum / static_cast<double>(points.size());
}

Result<volume::MaskGrid> usable_voxels(const volume::LabelGrid& us, const Beams& beams) {
  TROCAR_TRY(detail::WorkingUltrasound prepared, detail::prepare_ultrasound(us, beams));
  return std::move(prepared.usable);
}

Status check_confidence(const RigidRegistration& found, std::string_view unchanged) {
  if (found.confidence >= kLeastConfidence) return {};
  return fail(
      fmt::format(
          "no reliable registration: confidence {:.2f}, at least {:.2f} is needed (overlap {:.2f}, shadow {:.0f} "
          "%); {}",
          found.confidence, kLeastConfidence, found.overlap, 100.0 * found.shadow_share, unchanged),
      {}, "give landmarks, check orientation and beam axis, or try another start");
}

}  // namespace trocar::registration
