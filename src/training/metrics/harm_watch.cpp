#include "metrics/harm_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "anatomy/structure_words.h"
#include "metrics/detail/body.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr double kLeastTolerance_mm = 1.0;  // a finer grid does not make a needle's place better known [assumed]
constexpr double kCrossed = 1.5;            // voxels of a thin structure in the needle's way: it was crossed
constexpr double kHarmMoved_mm = 0.25;      // a needle that moved less is in the same structures
constexpr double kFastStep_mm = 1.0;        // the tip's way between two moments is tested, too
constexpr double kFarthest_mm = 500.0;      // of the shaft
constexpr double kToBone_mm = 0.5;          // from a tip that presses on bone to its label
constexpr double kNotchStep_mm = 0.25;

bool can_harm(const tasks::LabelHarm& harm) noexcept {
  return std::max({harm.grade, harm.notch, harm.stay}) > tasks::Harm::kNone;
}

std::string length_words(double mm) {
  return fmt::format("{:.{}f} mm", mm, mm < 1.0 ? 1 : 0);
}

}  // namespace

/// What a line has of one label.
struct HarmWatch::Piece {
  std::uint8_t id = 0;
  double length_mm = 0.0;
  double first_mm = 0.0;  ///< From the line's begin to its first point.
  double thin_mm = 0.0;   ///< Where the structure is thinner than two voxels.
  bool is_deep = false;
  bool is_crossed = false;  ///< Enough of a thin structure is on the way.

  bool is_graze() const noexcept { return !is_deep && !is_crossed; }
};

std::string harm_words(const HarmEvent& event) {
  const std::string name = anatomy::structure_words(event.label);
  const char* const what = event.is_by_stylet ? "stylet" : "needle";
  if (event.is_graze) return fmt::format("the {} grazed the {}", what, name);
  if (event.is_by_notch) return fmt::format("the notch closed in the {}", name);
  if (event.has_stayed) return fmt::format("the needle stayed in the {} for {:.0f} s", name, event.stayed_s);
  if (!(event.inside_mm > 0.0)) return fmt::format("the {} touched the {}", what, name);
  return fmt::format("the {} {} {} into the {}", what, event.is_by_stylet ? "shot" : "went",
                     length_words(event.inside_mm), name);
}

bool is_graver(const HarmEvent& a, const HarmEvent& b) noexcept {
  if (a.grade != b.grade) return a.grade > b.grade;
  if (a.is_graze != b.is_graze) return b.is_graze;
  return a.begin_s < b.begin_s;
}

HarmWatch::HarmWatch(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle)
    : patient_(&patient), needle_(needle) {
  event_of_.fill(-1);
  for (const anatomy::Label& label : patient.label_table.labels) {
    harms_[label.id] = tasks::find_harm(task, label);
    is_bone_[label.id] = label.tissue == "bone";
  }
  const Vec3& spacing_mm = patient.labels.geometry.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) resolution_index_[axis] = std::max(1.0, kLeastTolerance_mm / spacing_mm[axis]);
}

bool HarmWatch::is_deep(std::uint8_t id, const Vec3& p_P) const noexcept {
  const Vec3 index = patient_->labels.geometry.to_index(p_P);
  for (int n = 0; n < 27; ++n) {
    const Vec3 side(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const Vec3 beside_P = patient_->labels.geometry.to_mm(index + side.cwiseProduct(resolution_index_));
    const auto other = volume::sample_nearest<std::uint8_t>(patient_->labels, beside_P, 0);
    if (other != id && harms_[other].grade < harms_[id].grade) return false;
  }
  return true;
}

bool HarmWatch::is_thin(std::uint8_t id, const Vec3& p_P) const noexcept {
  const volume::GridGeometry& geometry = patient_->labels.geometry;
  const Vec3 index = geometry.to_index(p_P);
  const auto is_outside = [&](const Vec3& at_index) {
    const auto other = volume::sample_nearest<std::uint8_t>(patient_->labels, geometry.to_mm(at_index), 0);
    return other != id && harms_[other].grade < harms_[id].grade;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 side = resolution_index_[axis] * Vec3::Unit(axis);
    if (is_outside(index + side) && is_outside(index - side)) return true;
  }
  return false;
}

HarmEvent& HarmWatch::event_of(std::uint8_t id, double depth_mm, double time_s, bool is_by_stylet) {
  if (event_of_[id] < 0) {
    event_of_[id] = static_cast<std::int16_t>(events_.size());
    HarmEvent event;
    const anatomy::Label* const label = patient_->label_table.find(id);
    event.label = label != nullptr ? label->name : fmt::format("#{}", id);
    event.grade = tasks::Harm::kNone;
    event.is_graze = true;
    event.is_by_stylet = is_by_stylet;
    event.depth_mm = depth_mm;
    event.begin_s = event.worst_s = time_s;
    event.reason = harms_[id].reason;
    events_.push_back(std::move(event));
    told_.emplace_back(tasks::Harm::kNone, true);
  }
  HarmEvent& event = events_[static_cast<std::size_t>(event_of_[id])];
  event.is_by_stylet = event.is_by_stylet && is_by_stylet;
  return event;
}

void HarmWatch::raise(HarmEvent& event, tasks::Harm grade) noexcept {
  event.grade = std::max(event.grade, grade);
}

void HarmWatch::judge(const Piece& piece, double time_s, bool is_by_stylet) {
  HarmEvent& event = events_[static_cast<std::size_t>(event_of_[piece.id])];
  const tasks::LabelHarm& harm = harms_[piece.id];
  if (piece.length_mm > event.inside_mm) {
    event.inside_mm = piece.length_mm;
    event.worst_s = time_s;
  }
  if (!piece.is_graze() || is_bone_[piece.id]) event.is_graze = false;
  raise(event, piece.is_graze() ? std::min(harm.grade, tasks::Harm::kMinor) : harm.grade);
  if (is_by_stylet || piece.is_graze()) return;
  if (!now_[piece.id]) stays_since_s_[piece.id] = time_s;
  now_.set(piece.id);
}

void HarmWatch::walk(const Vec3& from_P, const Vec3& to_P, double depth_mm, double time_s, bool is_by_stylet) {
  std::vector<Piece> pieces;
  const Vec3 way_P = to_P - from_P;
  const double length_mm = std::min(way_P.norm(), kFarthest_mm);
  if (!(length_mm > 0.0)) return;
  const Vec3 direction_P = way_P.normalized();
  const int steps = static_cast<int>(std::ceil(length_mm / detail::kTestedEvery_mm));
  const double step_mm = length_mm / steps;
  const volume::GridGeometry& geometry = patient_->labels.geometry;
  const double voxel_mm =
      1.0 /
      (geometry.to_index(from_P + direction_P) - geometry.to_index(from_P)).cwiseQuotient(resolution_index_).norm();
  for (int n = 0; n < steps; ++n) {
    const double along_mm = (n + 0.5) * step_mm;
    const Vec3 p_P = from_P + along_mm * direction_P;
    const auto id = volume::sample_nearest<std::uint8_t>(patient_->labels, p_P, 0);
    if (!can_harm(harms_[id]) || (is_bone_[id] && !is_by_stylet)) continue;
    auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& one) { return one.id == id; });
    if (piece == pieces.end()) piece = pieces.insert(pieces.end(), {id, 0.0, along_mm});
    piece->length_mm += step_mm;
    piece->is_deep = piece->is_deep || is_deep(id, p_P);
    if (!piece->is_deep && is_thin(id, p_P)) piece->thin_mm += step_mm;
  }
  for (Piece& piece : pieces) {
    piece.is_crossed = piece.thin_mm >= kCrossed * voxel_mm;
    event_of(piece.id, depth_mm + piece.first_mm, time_s, is_by_stylet);
    judge(piece, time_s, is_by_stylet);
  }
}

void HarmWatch::stay(double time_s) {
  for (std::size_t id = 1; id < now_.size(); ++id) {
    if (!now_[id]) continue;
    HarmEvent& event = events_[static_cast<std::size_t>(event_of_[id])];
    event.stayed_s = std::max(event.stayed_s, time_s - stays_since_s_[id]);
    const tasks::LabelHarm& harm = harms_[id];
    if (harm.stay <= event.grade || !(event.stayed_s > harm.stay_s)) continue;
    event.has_stayed = true;
    event.worst_s = time_s;
    raise(event, harm.stay);
  }
}

void HarmWatch::step(const Moment& moment) {
  if (!std::isfinite(moment.time_s) || !moment.tip_P.allFinite() || !moment.axis_P.allFinite() || !moment.depth_mm ||
      !std::isfinite(*moment.depth_mm))
    return;
  if (moment.is_paused)
    for (double& since_s : stays_since_s_) since_s += moment.time_s - last_s_;
  last_s_ = moment.time_s;
  const double depth_mm = std::min(*moment.depth_mm - moment.pressed_mm, kFarthest_mm);
  if (!(depth_mm > 0.0)) {
    now_.reset();
    tip_P_.reset();
    return;
  }
  const Vec3 tip_P = moment.tip_P - moment.pressed_mm * moment.axis_P;
  const Vec3 skin_P = tip_P - depth_mm * moment.axis_P;
  const bool has_moved =
      !tip_P_ || (tip_P - *tip_P_).norm() > kHarmMoved_mm || (skin_P - skin_P_).norm() > kHarmMoved_mm;
  if (has_moved) {
    const std::optional<Vec3> way_from_P = std::exchange(tip_P_, tip_P);
    skin_P_ = skin_P;
    const std::bitset<256> before = std::exchange(now_, {});
    const std::array<double, 256> since_s = stays_since_s_;
    walk(skin_P, tip_P, 0.0, moment.time_s, false);
    if (way_from_P && !moment.is_paused && (tip_P - *way_from_P).norm() > kFastStep_mm)
      walk(*way_from_P, tip_P, depth_mm, moment.time_s, false);
    for (std::size_t id = 1; id < now_.size(); ++id)
      if (now_[id] && before[id]) stays_since_s_[id] = since_s[id];
    const Vec3 ahead_P = moment.tip_P + (moment.pressed_mm > 0.0 ? kToBone_mm : 0.0) * moment.axis_P;
    const auto id = volume::sample_nearest<std::uint8_t>(patient_->labels, ahead_P, 0);
    if (is_bone_[id] && can_harm(harms_[id])) {
      HarmEvent& event = event_of(id, *moment.depth_mm, moment.time_s, false);
      event.is_graze = false;
      raise(event, harms_[id].grade);
    }
  }
  stay(moment.time_s);
}

void HarmWatch::fire(const Moment& moment) {
  if (!std::isfinite(moment.time_s) || !moment.tip_P.allFinite() || !moment.axis_P.allFinite()) return;
  const auto id_at = [&](double beyond_mm) {
    return volume::sample_nearest<std::uint8_t>(patient_->labels, moment.tip_P + beyond_mm * moment.axis_P, 0);
  };
  double throw_mm = 0.0;
  while (throw_mm < needle_.throw_mm && !is_bone_[id_at(throw_mm)]) throw_mm += kNotchStep_mm;
  const bool is_stopped = throw_mm < needle_.throw_mm;
  throw_mm = std::min(throw_mm, needle_.throw_mm);
  const double depth_mm = moment.depth_mm.value_or(0.0);
  walk(moment.tip_P, moment.tip_P + throw_mm * moment.axis_P, depth_mm, moment.time_s, true);
  const auto bone = is_stopped ? id_at(throw_mm) : std::uint8_t{0};
  if (is_stopped && can_harm(harms_[bone])) {
    HarmEvent& event = event_of(bone, depth_mm + throw_mm, moment.time_s, true);
    event.is_graze = false;
    raise(event, harms_[bone].grade);
  }
  const double notch_end_mm = throw_mm - needle_.dead_space_mm;
  for (double at_mm = std::max(0.0, notch_end_mm - needle_.notch_mm); at_mm <= notch_end_mm; at_mm += kNotchStep_mm) {
    const std::uint8_t id = id_at(at_mm);
    if (event_of_[id] < 0) continue;
    HarmEvent& event = event_of(id, depth_mm + at_mm, moment.time_s, true);
    if (event.is_graze || harms_[id].notch <= event.grade) continue;
    event.is_by_notch = true;
    event.worst_s = moment.time_s;
    raise(event, harms_[id].notch);
  }
}

std::vector<HarmEvent> HarmWatch::take_news() {
  std::vector<HarmEvent> news;
  for (std::size_t n = 0; n < events_.size(); ++n) {
    const HarmEvent& event = events_[n];
    const std::pair<tasks::Harm, bool> now{event.grade, event.is_graze};
    if (now == told_[n] || event.grade == tasks::Harm::kNone) continue;
    told_[n] = now;
    news.push_back(event);
  }
  return news;
}

std::vector<HarmEvent> find_harms(const tasks::Task& task, const anatomy::VirtualPatient& patient,
                                  const tasks::Needle& needle, std::span<const telemetry::TickSample> samples,
                                  std::span<const std::size_t> shots,
                                  std::span<const tasks::Interruption> interruptions) {
  HarmWatch watch(task, patient, needle);
  auto pause = interruptions.begin();
  auto shot = shots.begin();
  for (std::size_t n = 0; n < samples.size(); ++n) {
    Moment moment = moment_of(samples[n]);
    for (; pause != interruptions.end() && pause->to_s <= moment.time_s; ++pause) moment.is_paused = n > 0;
    watch.step(moment);
    for (; shot != shots.end() && *shot <= n; ++shot) watch.fire(moment);
  }
  std::vector<HarmEvent> harms = watch.events();
  std::erase_if(harms, [](const HarmEvent& event) { return event.grade == tasks::Harm::kNone; });
  std::stable_sort(harms.begin(), harms.end(), is_graver);
  return harms;
}

}  // namespace trocar::metrics
