#include "lab/cases/segmentation_study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "haptics/tick.h"
#include "patient_builder/complete_labels.h"

namespace trocar::cases {
namespace {

constexpr std::size_t kPathsAtOnce = 64;  ///< Between two reports of progress.

/// A unit vector perpendicular to `axis`, rotated about it by `angle_rad`.
Vec3 across(const Vec3& axis, double angle_rad) {
  const Vec3 first = axis.unitOrthogonal();
  return std::cos(angle_rad) * first + std::sin(angle_rad) * axis.cross(first);
}

/// Two needles, one per scene; large, so a worker allocates them once for all its paths.
struct Needles {
  haptics::HapticState full;
  haptics::HapticState partly;
};

/// A tick behind the skin.
struct Difference {
  int tick = 0;
  double force_n = 0.0;  ///< |dF|
  Vec3 device_mm = Vec3::Zero();
  std::uint8_t tissue = 0;
};

/// A layer or a border that gave way.
struct GaveWay {
  int tick = 0;
  std::uint8_t layer = haptics::kNoLayer;
};

/// Notes what gives way in one scene, tick by tick.
class GiveWayNotes {
 public:
  explicit GiveWayNotes(const PrescribedMotion& motion)
      : suddenly_mm_(kSuddenly * motion.speed_mm_per_s * motion.dt_s) {}

  void note(const telemetry::TickSample& sample, int tick) {
    bool is_puncture = false;
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      noted_.push_back({tick, event.id});
      is_puncture = true;
    }
    // A tip that moves suddenly behind a layer does not pass a border.
    const bool is_sudden = is_puncture || sample.depth_mm - depth_mm_ > suddenly_mm_;
    if (is_sudden && !is_puncture && !was_sudden_) noted_.push_back({tick, kBorder});
    was_sudden_ = is_sudden;
    depth_mm_ = sample.depth_mm;
  }
  const std::vector<GaveWay>& noted() const noexcept { return noted_; }

 private:
  std::vector<GaveWay> noted_;
  double suddenly_mm_;
  double depth_mm_ = 0.0;
  bool was_sudden_ = false;
};

/// What gives way in two scenes on the same motion: intervals of ticks around those that both have at the same place,
/// and those that one has alone.
struct SharedPunctures {
  std::vector<std::pair<int, int>> both;
  std::vector<GaveWay> alone;
};
SharedPunctures share_punctures(const std::vector<GaveWay>& full, std::vector<GaveWay> partly,
                                const PrescribedMotion& motion) {
  constexpr double kRounding_mm = 1e-9;
  const int around = static_cast<int>(std::lround(kGiveWay_s / motion.dt_s));
  SharedPunctures shared;
  for (const GaveWay& a : full) {
    const auto same = std::find_if(partly.begin(), partly.end(), [&](const GaveWay& b) {
      const double apart_mm = std::abs(way_mm(motion, a.tick) - way_mm(motion, b.tick));
      return b.layer == a.layer && apart_mm <= kSamePlace_mm + kRounding_mm;
    });
    if (same == partly.end()) {
      shared.alone.push_back(a);
      continue;
    }
    shared.both.emplace_back(std::min(a.tick, same->tick) - around, std::max(a.tick, same->tick) + around);
    partly.erase(same);
  }
  shared.alone.insert(shared.alone.end(), partly.begin(), partly.end());
  return shared;
}

ErrorPlace place_of(const Difference& worst, const SharedPunctures& punctures, const haptics::HapticScene& full,
                    const PrescribedMotion& motion) {
  ErrorPlace place;
  place.time_s = worst.tick * motion.dt_s;
  place.depth_mm = way_mm(motion, worst.tick);
  place.tissue = worst.tissue;
  place.ahead = haptics::tissue_at(full, worst.device_mm).tissue;
  int nearest = static_cast<int>(std::lround(kGiveWay_s / motion.dt_s)) + 1;
  for (const GaveWay& alone : punctures.alone) {
    if (std::abs(alone.tick - worst.tick) >= nearest) continue;
    nearest = std::abs(alone.tick - worst.tick);
    place.layer = alone.layer;
  }
  return place;
}

/// The largest differences, with and without the moments at which a layer or a border gives way in both scenes.
void find_worst(PathError& error, const std::vector<Difference>& differences, const SharedPunctures& punctures,
                const haptics::HapticScene& full, const PrescribedMotion& motion) {
  const Difference* worst = nullptr;
  const Difference* apart = nullptr;
  for (const Difference& d : differences) {
    if (d.force_n > (worst ? worst->force_n : 0.0)) worst = &d;
    if (d.force_n <= (apart ? apart->force_n : 0.0)) continue;
    const bool gives_way = std::any_of(punctures.both.begin(), punctures.both.end(), [&](const auto& interval) {
      return d.tick >= interval.first && d.tick <= interval.second;
    });
    if (!gives_way) apart = &d;
  }
  if (worst) {
    error.max_n = worst->force_n;
    error.worst = place_of(*worst, punctures, full, motion);
  }
  if (apart) {
    error.max_apart_n = apart->force_n;
    error.worst_apart = place_of(*apart, punctures, full, motion);
  }
}

PathError compare_on_path(Needles& needles, const haptics::HapticScene& full, const haptics::HapticScene& partly,
                          const PrescribedMotion& motion) {
  needles.full = haptics::HapticState{};
  needles.partly = haptics::HapticState{};
  PathError error;
  error.line_P = motion.line_P;
  std::vector<Difference> differences;
  GiveWayNotes full_notes(motion), partly_notes(motion);
  double sum2 = 0.0;
  double torque2 = 0.0;
  double full2 = 0.0;
  const int count = tick_count(motion);
  for (int i = 1; i <= count; ++i) {
    const haptics::HapticInput input = input_at(motion, i);
    const haptics::HapticOutput a = haptics::tick(needles.full, input, full);
    const haptics::HapticOutput b = haptics::tick(needles.partly, input, partly);
    full_notes.note(a.sample, i);
    partly_notes.note(b.sample, i);
    if (way_mm(motion, i) <= 0.0) continue;
    const double difference_n = (a.total_W.force_n - b.total_W.force_n).norm();
    const double torque_nmm = (a.total_W.torque_nmm - b.total_W.torque_nmm).norm();
    const double force_n = a.total_W.force_n.norm();
    ++error.ticks;
    sum2 += difference_n * difference_n;
    torque2 += torque_nmm * torque_nmm;
    full2 += force_n * force_n;
    error.full_max_n = std::max(error.full_max_n, force_n);
    error.torque_max_nmm = std::max(error.torque_max_nmm, torque_nmm);
    if (difference_n > std::max(kAffected_n, kAffectedShare * force_n)) ++error.affected;
    differences.push_back({i, difference_n, a.sample.device_mm, a.sample.tissue});
  }
  find_worst(error, differences, share_punctures(full_notes.noted(), partly_notes.noted(), motion), full, motion);
  const double ticks = std::max(1, error.ticks);
  error.rms_n = std::sqrt(sum2 / ticks);
  error.torque_rms_nmm = std::sqrt(torque2 / ticks);
  error.full_rms_n = std::sqrt(full2 / ticks);
  return error;
}

}  // namespace

Result<anatomy::VirtualPatient> partly_segmented(const anatomy::VirtualPatient& full,
                                                 std::span<const std::string_view> tissues, Rest rest) {
  TROCAR_TRY(anatomy::VirtualPatient partly, patient_builder::with_segmented_only(full, tissues));
  if (rest == Rest::kUnlabelled) patient_builder::remove_found_labels(partly);
  partly.name += ", partly segmented";
  return partly;
}

std::vector<std::size_t> spread_choice(std::size_t available, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> chosen;
  count = std::min(count, available);
  chosen.reserve(count);
  // One from each of `count` equal parts: increasing and distinct, since a part contains at least one number.
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * available / count;
    const std::size_t to = (i + 1) * available / count;
    chosen.push_back(from + static_cast<std::size_t>(uniform01(seed, i) * static_cast<double>(to - from)));
  }
  return chosen;
}

PrescribedMotion study_motion(const Segment& line_P, std::size_t number, const StudyMotion& study) {
  Random random(mix64(study.seed) ^ number);
  PrescribedMotion motion;
  motion.line_P = line_P;
  motion.speed_mm_per_s = study.speed_mm_per_s;
  const Vec3 axis = line_P.direction();
  const auto any = [&](double most) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    return Vec3(random.uniform(0.0, most) * across(axis, angle));
  };
  motion.drift_P = any(study.max_drift_mm);
  motion.tilt_rad_P = any(study.max_tilt_rad);
  return motion;
}

std::vector<PathError> compare_forces(const haptics::HapticScene& full, const haptics::HapticScene& partly,
                                      std::span<const PrescribedMotion> motions, const Progress& progress) {
  std::vector<PathError> errors(motions.size());
  for (std::size_t from = 0; from < motions.size(); from += kPathsAtOnce) {
    report(progress, "comparing forces", static_cast<double>(from) / static_cast<double>(motions.size()));
    parallel_for(std::min(kPathsAtOnce, motions.size() - from), 4, [&](std::size_t first, std::size_t last) {
      const auto needles = std::make_unique<Needles>();
      for (std::size_t i = from + first; i < from + last; ++i)
        errors[i] = compare_on_path(*needles, full, partly, motions[i]);
    });
  }
  report(progress, "comparing forces", 1.0);
  return errors;
}

StudyFigures study_figures(std::span<const PathError> errors) {
  StudyFigures figures;
  figures.paths = errors.size();
  if (errors.empty()) return figures;
  double ticks = 0.0;
  for (const PathError& error : errors) {
    figures.mean_rms_n += error.rms_n;
    figures.mean_max_n += error.max_n;
    figures.mean_torque_rms_nmm += error.torque_rms_nmm;
    figures.mean_full_rms_n += error.full_rms_n;
    figures.max_n = std::max(figures.max_n, error.max_n);
    figures.max_torque_nmm = std::max(figures.max_torque_nmm, error.torque_max_nmm);
    figures.affected += error.affected;
    ticks += error.ticks;
  }
  const auto count = static_cast<double>(errors.size());
  figures.mean_rms_n /= count;
  figures.mean_max_n /= count;
  figures.mean_torque_rms_nmm /= count;
  figures.mean_full_rms_n /= count;
  figures.affected /= std::max(1.0, ticks);
  return figures;
}

std::vector<WorstPlace> worst_places(std::span<const PathError> errors, const anatomy::TissueTable& tissues) {
  std::map<std::string, WorstPlace> places;
  for (const PathError& error : errors) {
    if (!(error.max_n > 0.0)) continue;
    std::string name = tissues.tissues[error.worst.tissue].name;
    if (error.worst.ahead != error.worst.tissue) name += " > " + tissues.tissues[error.worst.ahead].name;
    WorstPlace& place = places[name];
    place.place = name;
    ++place.paths;
    place.mean_max_n += error.max_n;
    place.max_n = std::max(place.max_n, error.max_n);
  }
  std::vector<WorstPlace> sorted;
  for (auto& [name, place] : places) {
    place.mean_max_n /= place.paths;
    sorted.push_back(place);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const WorstPlace& a, const WorstPlace& b) { return a.paths > b.paths; });
  return sorted;
}

}  // namespace trocar::cases
