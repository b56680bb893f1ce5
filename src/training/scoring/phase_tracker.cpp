#include "scoring/phase_tracker.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numbers>
#include <utility>

#include "metrics/metric.h"
#include "scoring/core_sample.h"
#include "scoring/pain.h"
#include "tasks/fit_to_patient.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

using tasks::ActionKind;
using tasks::Condition;
using tasks::ConditionKind;

constexpr double kContact_n = 0.05;      // of a transducer that touches the skin
constexpr double kInPlane_mm = 4.0;      // from the tip to the image plane, for a needle in it [assumed]
constexpr double kOnSkin_mm = 2.5;       // of the tip from the resting skin, which gives way [assumed]
constexpr double kLineStep_mm = 1.0;     // of points along a line that is looked at
constexpr double kPassedDepth_mm = 5.0;  // inserted at least, so that the needle counts as having been in the body
constexpr int kDirections = 6;           // about the line

bool is_valid(const telemetry::TickSample& sample) noexcept {
  return std::isfinite(sample.time_s) && sample.tip_mm.allFinite() && sample.axis.allFinite() &&
         sample.rest_tip_mm.allFinite() && sample.rest_axis.allFinite() && std::isfinite(sample.depth_mm);
}

}  // namespace

struct PhaseTracker::Impl {
  /// Counts of what a phase asks for.
  struct Begin {
    int injections = 0, drawn_stylets = 0, held_breaths = 0, wires = 0, exits = 0;
    double wire_mm = 0.0, contrast_in_target_ml = 0.0, contrast_ml = 0.0;
    std::size_t cores = 0;
    std::optional<Vec3> tip_P;
  };

  const tasks::Task& task;
  const anatomy::VirtualPatient& patient;
  tasks::Needle needle;
  Segment plan_P;
  metrics::ImagePlane plane;
  tasks::TaskLabels labels;
  Vec3 target_P;  ///< What has to be hit: the tip's end position, with a gun the middle of the notch after the shot.
  std::optional<Vec3> fibres_P;  ///< Direction of the fibres at the target; empty: the task or the patient has none.
  std::vector<PhaseState> states;
  std::vector<double> held_since_s;  ///< Since when the conditions of each phase hold; NaN: they do not.
  std::vector<bool> is_repeated;     ///< It has to lapse before it can be done again.
  std::vector<Begin> begins;         ///< What had been done when each phase was repeated.
  // What actions and moments have changed so far.
  bool is_stylet_drawn = false, is_breath_held = false, has_been_inside = false;
  Begin done;                                                 ///< Since the attempt began.
  std::vector<std::pair<double, tasks::Substance>> returned;  ///< Times and substances.
  std::bitset<256> passed;                                    ///< Labels that the tip was in, of this insertion.

  Impl(const tasks::Task& t, const anatomy::VirtualPatient& p, const tasks::Needle& n, const tasks::PlannedPath& plan,
       const metrics::ImagePlane& image)
      : task(t),
        patient(p),
        needle(n),
        plan_P(plan.line_P),
        plane(image),
        labels(t, p),
        target_P(plan.line_P.b + n.notch_middle_mm() * plan.line_P.direction()),
        fibres_P(tasks::find_fibres(t, p, plan.line_P.b)),
        states(t.phases.size()),
        held_since_s(t.phases.size(), std::nan("")),
        is_repeated(t.phases.size(), false),
        begins(t.phases.size()) {}

  bool holds(const Condition& condition, std::size_t phase, const PhaseMoment& moment) const;
  bool holds_of_actions(const Condition& condition, std::size_t phase) const;
  bool holds_of_image(const Condition& condition, const PhaseMoment& moment) const;
  bool is_in_image(const PhaseMoment& moment, const Vec3& p_P, double most_mm) const;
  bool is_path_clear(const PhaseMoment& moment, double margin_mm) const;
  bool is_in_target(const Vec3& p_P) const;
  bool has_passed(std::string_view names) const;
  void note_place(const PhaseMoment& moment);
  void update(const PhaseMoment& moment);
  void open(double now_s);
};

bool PhaseTracker::Impl::is_in_image(const PhaseMoment& moment, const Vec3& p_P, double most_mm) const {
  const Pose& X_PT = *moment.X_PT;
  const Vec3 p_T = X_PT.inverse() * p_P;
  return std::abs(p_T.z()) <= most_mm && plane.is_in_field(p_T) &&
         !metrics::find_shadow(patient, moment.motion, plane, X_PT, p_P);
}

bool PhaseTracker::Impl::holds_of_image(const Condition& condition, const PhaseMoment& moment) const {
  if (!moment.X_PT) return false;
  const Pose& X_PT = *moment.X_PT;
  const telemetry::TickSample& sample = moment.needle;
  switch (condition.kind) {
    case ConditionKind::kTargetInImage:
      return moment.contact_n >= kContact_n && is_in_image(moment, moment.motion.to_now(target_P), condition.number);
    case ConditionKind::kTipInImage:
      return moment.contact_n >= kContact_n && is_in_image(moment, sample.tip_mm, condition.number);
    case ConditionKind::kNeedleInPlane: {
      const double across = std::abs(sample.axis.dot(X_PT.R().col(2)));
      const double angle_deg = kDegPerRad * std::asin(std::min(across, 1.0));
      return angle_deg <= condition.number && std::abs((X_PT.inverse() * sample.tip_mm).z()) <= kInPlane_mm;
    }
    default:
      return moment.contact_n >= kContact_n;
  }
}

/// From the tip straight on to beside the target: every point and those around it at the margin.
bool PhaseTracker::Impl::is_path_clear(const PhaseMoment& moment, double margin_mm) const {
  const Vec3 &tip_P = moment.needle.rest_tip_mm, &axis_P = moment.needle.rest_axis;
  const double length_mm = std::clamp((plan_P.b - tip_P).dot(axis_P), 0.0, 300.0);
  const Vec3 u_P = axis_P.unitOrthogonal(), v_P = axis_P.cross(u_P);
  const auto is_free = [&](const Vec3& p_P) {
    const std::uint8_t id = volume::sample_nearest<std::uint8_t>(patient.labels, p_P, 0);
    return labels.risk(id) == nullptr && labels.harm(id) == tasks::Harm::kNone;
  };
  for (double along_mm = 0.0; along_mm <= length_mm; along_mm += kLineStep_mm) {
    const Vec3 p_P = tip_P + along_mm * axis_P;
    if (!is_free(p_P)) return false;
    if (margin_mm <= 0.0) continue;
    for (int n = 0; n < kDirections; ++n) {
      const double angle_rad = 2.0 * std::numbers::pi * n / kDirections;
      if (!is_free(p_P + margin_mm * (std::cos(angle_rad) * u_P + std::sin(angle_rad) * v_P))) return false;
    }
  }
  return true;
}

bool PhaseTracker::Impl::is_in_target(const Vec3& p_P) const {
  const anatomy::Label* const label = anatomy::find_label(patient, p_P);
  return label != nullptr && tasks::is_target(task, *label);
}

bool PhaseTracker::Impl::has_passed(std::string_view names) const {
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find('|'));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const bool is_passed = std::ranges::any_of(patient.label_table.labels, [&](const anatomy::Label& label) {
      return passed[label.id] && (label.tissue == name || label.name == name);
    });
    if (is_passed) return true;
  }
  return false;
}

bool PhaseTracker::Impl::holds_of_actions(const Condition& condition, std::size_t phase) const {
  const Begin& begin = begins[phase];
  switch (condition.kind) {
    case ConditionKind::kStyletDrawn:
      return is_stylet_drawn && done.drawn_stylets > begin.drawn_stylets;
    case ConditionKind::kReturned: {
      const auto wanted = tasks::find_substance(condition.name);
      const std::optional<double>& begun_s = states[phase].begun_s;
      return std::any_of(returned.begin(), returned.end(), [&](const auto& entry) {
        return entry.second == wanted && begun_s && entry.first >= *begun_s;
      });
    }
    case ConditionKind::kAnaesthetised:
      return done.injections > begin.injections;
    case ConditionKind::kContrast:
      return done.contrast_in_target_ml - begin.contrast_in_target_ml >= condition.number;
    case ConditionKind::kWire:
      return done.wire_mm >= condition.number && done.wires > begin.wires;
    case ConditionKind::kFired:
      return done.cores > begin.cores;
    case ConditionKind::kCores:
      return static_cast<double>(done.cores) >= condition.number && (!is_repeated[phase] || done.cores > begin.cores);
    case ConditionKind::kOutside:
      return done.exits > begin.exits;
    default:
      return false;
  }
}

bool PhaseTracker::Impl::holds(const Condition& condition, std::size_t phase, const PhaseMoment& moment) const {
  const telemetry::TickSample& sample = moment.needle;
  const Vec3 pierced_P = telemetry::pierced_rest_tip_mm(sample);
  switch (condition.kind) {
    case ConditionKind::kProbeOnSkin:
    case ConditionKind::kTargetInImage:
    case ConditionKind::kNeedleInPlane:
    case ConditionKind::kTipInImage:
      return holds_of_image(condition, moment);
    case ConditionKind::kTipOnSkin:
      return sample.depth_mm > 0.0 ||
             (!patient.skin_distance_mm.empty() &&
              volume::sample_linear(patient.skin_distance_mm, sample.rest_tip_mm) <= kOnSkin_mm);
    case ConditionKind::kAimsAtTarget: {
      const Vec3 to_target_P = target_P - sample.rest_tip_mm;
      return to_target_P.norm() < 1.0 ||
             kDegPerRad * angle_between_rad(sample.rest_axis, to_target_P) <= condition.number;
    }
    case ConditionKind::kPathClear:
      return is_path_clear(moment, condition.number);
    case ConditionKind::kInserted:
      return telemetry::is_in_body(sample) && sample.depth_mm >= condition.number;
    case ConditionKind::kTargetDistance: {
      const Vec3 reach_P = pierced_P + needle.notch_middle_mm() * sample.rest_axis;
      return (reach_P - target_P).norm() <= condition.number;
    }
    case ConditionKind::kTipIn: {
      const anatomy::Label* const label = anatomy::find_label(patient, pierced_P);
      return label != nullptr && (label->tissue == condition.name || label->name == condition.name);
    }
    case ConditionKind::kPassed:
      return has_passed(condition.name);
    case ConditionKind::kThrowClear:
      return take_core(task, patient, needle, sample.rest_tip_mm, sample.rest_axis).risks_in_throw.empty();
    case ConditionKind::kBevelToFibres: {
      const Mat3 R_PN = telemetry::device_pose(sample).R();
      return fibres_P && tasks::bevel_to_fibres_deg(R_PN, *fibres_P) <= condition.number;
    }
    case ConditionKind::kBreathHeld:  // a patient who does not breathe is asked all the same
      return done.held_breaths > begins[phase].held_breaths &&
             (moment.motion.is_rest() ? is_breath_held : sample.is_breath_held);
    case ConditionKind::kMoved:
      return (sample.rest_tip_mm - *begins[phase].tip_P).norm() >= condition.number;
    default:
      return holds_of_actions(condition, phase);
  }
}

/// What the tip is in, and whether it came out.
void PhaseTracker::Impl::note_place(const PhaseMoment& moment) {
  const telemetry::TickSample& sample = moment.needle;
  const Vec3 pierced_P = telemetry::pierced_rest_tip_mm(sample);
  done.tip_P = sample.rest_tip_mm;
  for (Begin& begin : begins)
    if (!begin.tip_P) begin.tip_P = sample.rest_tip_mm;
  if (!telemetry::is_in_body(sample)) {
    passed.reset();
    if (std::exchange(has_been_inside, false)) ++done.exits;
  } else {
    has_been_inside |= sample.depth_mm >= kPassedDepth_mm;
    passed.set(volume::sample_nearest<std::uint8_t>(patient.labels, pierced_P, 0));
  }
  if (moment.contrast_ml > done.contrast_ml && is_in_target(pierced_P))
    done.contrast_in_target_ml += moment.contrast_ml - done.contrast_ml;
  done.contrast_ml = std::max(done.contrast_ml, moment.contrast_ml);
  done.cores = std::max(done.cores, moment.cores);
}

void PhaseTracker::Impl::open(double now_s) {
  for (std::size_t n = 0; n < states.size(); ++n) {
    PhaseState& state = states[n];
    if (state.is_open) continue;
    const std::vector<std::string>& after = task.phases[n].after;
    state.is_open = std::all_of(after.begin(), after.end(), [&](const std::string& name) {
      const auto before = std::ranges::find(task.phases, name, &tasks::Phase::name);
      return before != task.phases.end() &&
             states[static_cast<std::size_t>(before - task.phases.begin())].done_s.has_value();
    });
    if (state.is_open) state.begun_s = now_s;
  }
}

void PhaseTracker::Impl::update(const PhaseMoment& moment) {
  const double now_s = moment.needle.time_s;
  note_place(moment);
  open(now_s);
  for (std::size_t n = 0; n < states.size(); ++n) {
    PhaseState& state = states[n];
    if (!state.is_open || state.done_s) continue;
    state.lacks.clear();
    for (const Condition& condition : task.phases[n].done)
      if (!holds(condition, n, moment)) state.lacks.push_back(tasks::condition_words(condition));
    if (!state.lacks.empty()) {
      held_since_s[n] = std::nan("");
      is_repeated[n] = false;
      continue;
    }
    if (is_repeated[n]) {
      state.lacks.emplace_back("do it once more");
      continue;
    }
    if (std::isnan(held_since_s[n])) held_since_s[n] = now_s;
    if (now_s - held_since_s[n] >= task.phases[n].hold_s) state.done_s = now_s;
  }
  open(now_s);
}

PhaseTracker::PhaseTracker(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                           const tasks::PlannedPath& plan, const metrics::ImagePlane& plane)
    : impl_(std::make_unique<Impl>(task, patient, needle, plan, plane)) {}
PhaseTracker::~PhaseTracker() = default;
PhaseTracker::PhaseTracker(PhaseTracker&&) noexcept = default;
PhaseTracker& PhaseTracker::operator=(PhaseTracker&&) noexcept = default;

void PhaseTracker::note(const tasks::Action& action) {
  Impl& impl = *impl_;
  switch (action.kind) {
    case ActionKind::kAnaesthetise:
      if (why_not_numb(action, impl.patient).empty()) ++impl.done.injections;
      break;
    case ActionKind::kDrawStylet:
      impl.is_stylet_drawn = true;
      ++impl.done.drawn_stylets;
      break;
    case ActionKind::kReplaceStylet:
      impl.is_stylet_drawn = false;
      break;
    case ActionKind::kAspirate:
    case ActionKind::kFire:  // told by the moments
    case ActionKind::kLoad:
      break;
    case ActionKind::kAdvanceWire:
      impl.done.wire_mm = action.amount;
      ++impl.done.wires;
      break;
    case ActionKind::kHoldBreath:
      impl.is_breath_held = true;
      ++impl.done.held_breaths;
      break;
    case ActionKind::kBreathe:
      impl.is_breath_held = false;
      break;
  }
  if (action.result.substance != tasks::Substance::kNothing)
    impl.returned.emplace_back(action.time_s, action.result.substance);
}

void PhaseTracker::step(const PhaseMoment& moment) {
  if (is_valid(moment.needle)) impl_->update(moment);
}

std::span<const PhaseState> PhaseTracker::states() const noexcept {
  return impl_->states;
}

std::optional<std::size_t> PhaseTracker::current() const noexcept {
  const std::vector<PhaseState>& states = impl_->states;
  for (std::size_t n = 0; n < states.size(); ++n)
    if (states[n].is_open && !states[n].done_s) return n;
  return std::nullopt;
}

void PhaseTracker::repeat(std::size_t phase) {
  Impl& impl = *impl_;
  if (phase >= impl.states.size()) return;
  impl.states[phase] = {};
  impl.held_since_s[phase] = std::nan("");
  impl.is_repeated[phase] = true;
  impl.begins[phase] = impl.done;
  for (std::size_t n = 0; n < impl.states.size(); ++n) {
    const std::vector<std::string>& after = impl.task.phases[n].after;
    const bool follows = std::ranges::find(after, impl.task.phases[phase].name) != after.end();
    if (follows && n != phase && impl.states[n].is_open) repeat(n);
  }
}

}  // namespace trocar::scoring
