#include "metrics/harm_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "anatomy/structure_words.h"
#include "metrics/detail/body.h"
#include "volume/distance.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr double kLeastTolerance_mm = 1.0;  // a finer grid does not make a needle's place better known [assumed]
constexpr double kThinShare = 0.5;          // deeper than this share of a thin structure's half thickness [assumed]
constexpr double kLongestGraze_mm = 8.0;    // along a surface, and at most a structure's thickness [assumed]
constexpr double kAbout_mm = 6.0;           // around a point: its surroundings, as far as they count
constexpr float kBeyond_mm = 100.0F;
constexpr double kSameStay_s = 0.5;     // a needle that left for less has stayed [assumed]
constexpr double kHarmMoved_mm = 0.25;  // a needle that moved less is in the same structures
constexpr double kFastStep_mm = 1.0;    // the tip's way between two moments is tested, too
constexpr double kFarthest_mm = 500.0;  // of the shaft
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
  double first_mm = 0.0;           ///< From the line's begin to its first point.
  double half_thickness_mm = 0.0;  ///< Of the structure there.
  bool is_deep = false;

  bool is_graze() const noexcept {
    return !is_deep && length_mm <= std::min(kLongestGraze_mm, 2.0 * half_thickness_mm);
  }
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
  left_s_.fill(-HUGE_VAL);
  for (const anatomy::Label& label : patient.label_table.labels) {
    harms_[label.id] = tasks::find_harm(task, label);
    is_bone_[label.id] = label.tissue == "bone";
    is_vessel_[label.id] = label.tissue == "vessel";
  }
  tolerance_mm_ = std::max(kLeastTolerance_mm, patient.labels.geometry.spacing_mm.maxCoeff());
}

/// Depths below the surface of what harms at least as much as a label, in a box of voxels about a place.
struct HarmWatch::Depths {
  volume::FloatGrid signed_mm;  ///< Negative inside.
  Vec3 middle_P = Vec3::Zero();
  double half_thickness_mm = 0.0;  ///< The largest depth within kAbout_mm of the middle.

  /// Of the voxel that holds the point: the labels do not say more.
  double at_mm(const Vec3& p_P) const noexcept { return -volume::sample_nearest(signed_mm, p_P, kBeyond_mm); }
};

const HarmWatch::Depths& HarmWatch::depths_about(std::uint8_t id, const Vec3& p_P) {
  std::shared_ptr<const Depths>& kept = depths_[id];
  if (kept && (kept->middle_P - p_P).norm() <= kAbout_mm) return *kept;
  const volume::LabelGrid& labels = patient_->labels;
  auto made = std::make_shared<Depths>();
  made->middle_P = p_P;
  const Vec3 index = labels.geometry.to_index(p_P);
  volume::GridGeometry geometry = labels.geometry;
  volume::Index3 low{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto reach = static_cast<std::int64_t>(std::ceil(2.0 * kAbout_mm / labels.geometry.spacing_mm[axis]));
    low[a] = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::lround(index[axis])) - reach);
    const std::int64_t high = std::min<std::int64_t>(labels.geometry.size[a] - 1, low[a] + 2 * reach);
    geometry.size[a] = std::max<std::int64_t>(1, high - low[a] + 1);
  }
  geometry.origin_P = labels.geometry.centre_mm(low);
  volume::MaskGrid mask(geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const std::uint8_t other = labels[{low[0] + ijk[0], low[1] + ijk[1], low[2] + ijk[2]}];
    mask.voxels[n] = other == id || harms_[other].grade >= harms_[id].grade ? 1 : 0;
  }
  made->signed_mm = volume::signed_distance_mm(mask);
  for (std::size_t n = 0; n < made->signed_mm.voxels.size(); ++n) {
    float& value_mm = made->signed_mm.voxels[n];
    value_mm = std::clamp(value_mm, -kBeyond_mm, kBeyond_mm);  // infinite where the box has no surface
    if ((geometry.centre_mm(geometry.index_of(n)) - p_P).squaredNorm() < kAbout_mm * kAbout_mm)
      made->half_thickness_mm = std::max(made->half_thickness_mm, -static_cast<double>(value_mm));
  }
  kept = std::move(made);
  return *kept;
}

/// Deeper below the surface than the labels resolve, or than a share of a thin structure.
bool HarmWatch::is_deep(std::uint8_t id, const Vec3& p_P) {
  const Depths& depths = depths_about(id, p_P);
  return depths.at_mm(p_P) > std::min(tolerance_mm_, kThinShare * depths.half_thickness_mm);
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
  if (is_by_stylet || event.is_graze) return;
  if (time_s - left_s_[piece.id] > kSameStay_s) stays_since_s_[piece.id] = time_s;
  left_s_[piece.id] = time_s;
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
  for (int n = 0; n < steps; ++n) {
    const double along_mm = (n + 0.5) * step_mm;
    const Vec3 p_P = from_P + along_mm * direction_P;
    const auto id = volume::sample_nearest<std::uint8_t>(patient_->labels, p_P, 0);
    if (!can_harm(harms_[id]) || (is_bone_[id] && !is_by_stylet)) continue;
    auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& one) { return one.id == id; });
    if (piece == pieces.end()) piece = pieces.insert(pieces.end(), {id, 0.0, along_mm});
    piece->length_mm += step_mm;
    piece->is_deep = piece->is_deep || is_known(id) || is_deep(id, p_P);
    if (!piece->is_deep)
      piece->half_thickness_mm = std::max(piece->half_thickness_mm, depths_about(id, p_P).half_thickness_mm);
  }
  for (const Piece& piece : pieces) {
    event_of(piece.id, depth_mm + piece.first_mm, time_s, is_by_stylet);
    judge(piece, time_s, is_by_stylet);
  }
}

/// It was in the structure beyond a graze before: nothing is to be found out any more.
bool HarmWatch::is_known(std::uint8_t id) const noexcept {
  return event_of_[id] >= 0 && !events_[static_cast<std::size_t>(event_of_[id])].is_graze;
}

void HarmWatch::stay(double time_s) {
  for (std::size_t id = 1; id < now_.size(); ++id) {
    if (!now_[id]) continue;
    HarmEvent& event = events_[static_cast<std::size_t>(event_of_[id])];
    left_s_[id] = time_s;
    event.stayed_s = std::max(event.stayed_s, time_s - stays_since_s_[id]);
    const tasks::LabelHarm& harm = harms_[id];
    if (harm.stay <= event.grade || !(event.stayed_s > harm.stay_s)) continue;
    event.has_stayed = true;
    event.worst_s = time_s;
    raise(event, harm.stay);
  }
}

void HarmWatch::step(const Moment& moment) {
  if (!std::isfinite(moment.time_s) || !moment.tip_A().allFinite() || !moment.axis_A().allFinite() ||
      !moment.depth_mm || !std::isfinite(*moment.depth_mm))
    return;
  if (moment.is_paused)
    for (std::size_t id = 0; id < stays_since_s_.size(); ++id) {
      stays_since_s_[id] += moment.time_s - last_s_;
      left_s_[id] += moment.time_s - last_s_;
    }
  last_s_ = moment.time_s;
  const double depth_mm = std::min(*moment.depth_mm - moment.pressed_mm, kFarthest_mm);
  if (!(depth_mm > 0.0)) {
    now_.reset();
    tip_P_.reset();
    return;
  }
  const Vec3 tip_P = moment.tip_A() - moment.pressed_mm * moment.axis_A();
  const Vec3 skin_P = tip_P - depth_mm * moment.axis_A();
  const bool has_moved =
      !tip_P_ || (tip_P - *tip_P_).norm() > kHarmMoved_mm || (skin_P - skin_P_).norm() > kHarmMoved_mm;
  if (has_moved) {
    const std::optional<Vec3> way_from_P = std::exchange(tip_P_, tip_P);
    skin_P_ = skin_P;
    now_.reset();
    walk(skin_P, tip_P, 0.0, moment.time_s, false);
    if (way_from_P && !moment.is_paused && (tip_P - *way_from_P).norm() > kFastStep_mm)
      walk(*way_from_P, tip_P, depth_mm, moment.time_s, false);
  }
  touch_bone(moment);
  stay(moment.time_s);
}

/// A tip that presses on bone does not move: it is looked at in every moment.
void HarmWatch::touch_bone(const Moment& moment) {
  const std::uint8_t id = detail::label_ahead(*patient_, moment);
  if (!is_bone_[id] || !can_harm(harms_[id])) return;
  HarmEvent& event = event_of(id, *moment.depth_mm, moment.time_s, false);
  event.is_graze = false;
  raise(event, harms_[id].grade);
}

void HarmWatch::fire(const Moment& moment) {
  if (!std::isfinite(moment.time_s) || !moment.tip_A().allFinite() || !moment.axis_A().allFinite()) return;
  const auto id_at = [&](double beyond_mm) {
    return volume::sample_nearest<std::uint8_t>(patient_->labels, moment.tip_A() + beyond_mm * moment.axis_A(), 0);
  };
  double throw_mm = 0.0;
  while (throw_mm < needle_.throw_mm && !is_bone_[id_at(throw_mm)]) throw_mm += kNotchStep_mm;
  const bool is_stopped = throw_mm < needle_.throw_mm;
  throw_mm = std::min(throw_mm, needle_.throw_mm);
  const double depth_mm = moment.depth_mm.value_or(0.0);
  walk(moment.tip_A(), moment.tip_A() + throw_mm * moment.axis_A(), depth_mm, moment.time_s, true);
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

void HarmWatch::note(const tasks::Action& action) {
  const tasks::Substance substance = action.result.substance;
  if (substance == tasks::Substance::kNothing) return;
  const Vec3 axis_P =
      tip_P_ && (*tip_P_ - skin_P_).norm() > 0.0 ? Vec3((*tip_P_ - skin_P_).normalized()) : Vec3::Zero();
  std::bitset<256> in_bevel;
  bool has_vessel = false;
  for (double back_mm = 0.0; back_mm <= tasks::bevel_opening_mm(needle_); back_mm += kNotchStep_mm) {
    const auto id = volume::sample_nearest<std::uint8_t>(patient_->labels, action.tip_A - back_mm * axis_P, 0);
    in_bevel[id] = event_of_[id] >= 0;
    has_vessel = has_vessel || (in_bevel[id] && is_vessel_[id]);
  }
  const bool is_of_vessel = substance == tasks::Substance::kBlood && has_vessel;  // else of an organ, by a syringe
  for (std::size_t id = 1; id < in_bevel.size(); ++id) {
    if (!in_bevel[id] || is_vessel_[id] != is_of_vessel) continue;
    HarmEvent& event = events_[static_cast<std::size_t>(event_of_[id])];
    event.is_graze = false;
    raise(event, harms_[id].grade);
  }
}

const HarmEvent* HarmWatch::present() const noexcept {
  const HarmEvent* gravest = nullptr;
  for (std::size_t id = 1; id < now_.size(); ++id) {
    if (!now_[id]) continue;
    const HarmEvent& event = events_[static_cast<std::size_t>(event_of_[id])];
    if (gravest == nullptr || is_graver(event, *gravest)) gravest = &event;
  }
  return gravest;
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
                                  std::span<const tasks::Interruption> interruptions,
                                  std::span<const tasks::Action> actions) {
  HarmWatch watch(task, patient, needle);
  auto pause = interruptions.begin();
  auto shot = shots.begin();
  auto action = actions.begin();
  for (std::size_t n = 0; n < samples.size(); ++n) {
    Moment moment = moment_of(samples[n]);
    for (; pause != interruptions.end() && pause->to_s <= moment.time_s; ++pause) moment.is_paused = n > 0;
    watch.step(moment);
    for (; shot != shots.end() && *shot <= n; ++shot) watch.fire(moment);
    for (; action != actions.end() && action->time_s <= moment.time_s; ++action) watch.note(*action);
  }
  std::vector<HarmEvent> harms = watch.events();
  std::erase_if(harms, [](const HarmEvent& event) { return event.grade == tasks::Harm::kNone; });
  std::stable_sort(harms.begin(), harms.end(), is_graver);
  return harms;
}

}  // namespace trocar::metrics
