#include "attempt/live/attempt_watch.h"

#include <fmt/format.h>

#include <limits>

#include "attempt/guide/needle_view.h"
#include "attempt/guide/puncture_guide.h"
#include "core/text.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

AttemptWatch::AttemptWatch(const cases::Case& the_case, const AttemptRecord& record,
                           const std::optional<metrics::ImagePlane>& plane)
    : case_(&the_case),
      record_(&record),
      plane_(plane),
      pain_(the_case.task, *the_case.patient),
      harm_(the_case.task, *the_case.patient, the_case.needle) {
  if (plane) phases_.emplace(the_case.task, *the_case.patient, the_case.needle, the_case.plan, *plane);
}

// ---- What happens

void AttemptWatch::take(const telemetry::TickSample& sample) {
  trace_.add({sample.time_s, sample.depth_mm, telemetry::axial_resistance_n(sample)});
  if (!contact_s_ && sample.phase != telemetry::InsertionPhase::kOutside) contact_s_ = sample.time_s;
  for (const telemetry::TickEvent& event : sample.events) {
    if (event.kind == telemetry::EventKind::kNone) break;
    if (auto described = describe_event(record_->info(), sample, event)) events_.push_back(*std::move(described));
  }
  if (const auto pain = pain_.step(sample)) events_.push_back(describe_pain(*pain));
  harm_.step(metrics::moment_of(sample));
  take_harm(sample);
  take_breath(sample);
}

/// The patient begins some time after being asked, and ends it when the breath is short.
void AttemptWatch::take_breath(const telemetry::TickSample& sample) {
  if (sample.is_breath_held == is_breath_held_) return;
  is_breath_held_ = sample.is_breath_held;
  const char* const text = is_breath_held_        ? "the patient holds the breath"
                           : is_breath_asked_for_ ? "the patient has to breathe"
                                                  : "the patient breathes again";
  if (!is_breath_held_) is_breath_asked_for_ = false;
  events_.push_back({sample.time_s, sample.depth_mm, telemetry::EventKind::kNone, "breath", text});
}

void AttemptWatch::take_harm(const telemetry::TickSample& sample) {
  for (const metrics::HarmEvent& event : harm_.take_news()) {
    events_.push_back(describe_harm(event, sample));
    if (event.grade < tasks::Harm::kMajor) continue;
    told_harm_ = event;
    told_harm_s_ = sample.time_s;
  }
}

void AttemptWatch::take_actions() {
  take_shots();
  const std::vector<tasks::Action>& actions = record_->actions();
  for (; told_actions_ < actions.size(); ++told_actions_) {
    const tasks::Action& action = actions[told_actions_];
    if (phases_) phases_->note(action);
    pain_.note(action);
    harm_.note(action);
    if (action.kind == tasks::ActionKind::kHoldBreath) is_breath_asked_for_ = true;
    if (action.kind == tasks::ActionKind::kBreathe) is_breath_asked_for_ = false;
    if (action.kind == tasks::ActionKind::kFire) continue;  // told as a shot
    events_.push_back(describe_action(case_->substances, action, case_->patient.get()));
  }
}

void AttemptWatch::take_shots() {
  const std::vector<std::size_t>& shots = record_->shots();
  for (; told_shots_ < shots.size(); ++told_shots_) {
    const telemetry::TickSample& fired = record_->samples()[shots[told_shots_]];
    shot_ = std::make_shared<const GunShot>(make_gun_shot(*case_, fired));
    if (!shot_->pieces.empty()) ++cores_;
    // The composition of the core is displayed beside its picture.
    events_.push_back({shot_->time_s, shot_->depth_mm, telemetry::EventKind::kNone, "shot",
                       shot_->is_in_body() ? fmt::format("the gun was fired at {:.0f}\u00a0mm", shot_->depth_mm)
                                           : "the gun was fired outside the body"});
    harm_.fire(metrics::moment_of(fired));
    take_harm(fired);
  }
}

void AttemptWatch::take(const tasks::XrayUse& use) {
  const double ml = use.contrast_ml - contrast_ml_;
  contrast_ml_ = use.contrast_ml;
  if (!(ml > 0.0)) return;
  if (!injection_) injection_.emplace();
  injection_->end_s = use.time_s;
  injection_->ml += ml;
  injection_->total_ml = use.contrast_ml;
}

/// When it has ended.
void AttemptWatch::tell_injection(const telemetry::TickSample& needle) {
  if (!injection_ || needle.time_s - injection_->end_s < tasks::kBetweenInjections_s) return;
  events_.push_back(describe_injection(*injection_, needle.depth_mm));
  injection_.reset();
}

void AttemptWatch::repeat_phase(std::size_t phase) {
  if (phases_) phases_->repeat(phase);
}

void AttemptWatch::step(const telemetry::TickSample& needle, const telemetry::TickSample* transducer,
                        const motion::PatientMotion& motion) {
  constexpr double kEvery_s = 0.02;
  tell_injection(needle);
  if (!phases_ || needle.time_s < phases_s_ + kEvery_s) return;
  phases_s_ = needle.time_s;
  scoring::PhaseMoment moment;
  moment.needle = needle;
  moment.motion = motion;
  if (transducer != nullptr) {
    moment.X_PT = telemetry::felt_probe(*transducer);
    moment.contact_n = transducer->f_constraint_n.norm();
  }
  moment.contrast_ml = contrast_ml_;
  moment.cores = cores_;
  phases_->step(moment);
}

// ---- What is shown of it

void AttemptWatch::add_to(AttemptView& view, const telemetry::TickSample& needle, double active_s,
                          const std::string& level) const {
  view.shots = record_->shots().size();
  view.is_gun_loaded = tasks::is_gun_loaded(record_->actions());
  view.session_s = active_s;
  if (contact_s_) view.since_contact_s = tasks::active_time_s(*contact_s_, needle.time_s, record_->interruptions());
  view.is_breath_held = is_breath_asked_for_;
  view.shot = shot_;
  if (shot_) view.since_shot_s = needle.time_s - shot_->time_s;
  const tasks::Action* wire = tasks::find_wire(record_->actions(), std::numeric_limits<double>::infinity());
  if (wire != nullptr) view.wire_mm = wire->amount;
  for (const tasks::Action& action : record_->actions()) {
    if (action.kind == tasks::ActionKind::kDrawStylet) view.is_stylet_drawn = true;
    if (action.kind == tasks::ActionKind::kReplaceStylet) view.is_stylet_drawn = false;
  }
  if (level == "exam") return;
  if (view.banner.empty()) add_harm(view, needle.time_s);
  add_phases(view);
}

/// At once, as long as the needle is in the structure, and for long enough to be read; an exam tells it at its end.
void AttemptWatch::add_harm(AttemptView& view, double now_s) const {
  constexpr double kShown_s = 6.0;
  const metrics::HarmEvent* told = harm_.present();
  if (told != nullptr && told->grade < tasks::Harm::kMajor) told = nullptr;
  if (told == nullptr && told_harm_ && now_s - told_harm_s_ < kShown_s) told = &*told_harm_;
  if (told == nullptr) return;
  view.is_harm = true;
  view.banner = fmt::format("{} harm: {}{}. Pull back.", told->grade == tasks::Harm::kCritical ? "Critical" : "Major",
                            metrics::harm_words(*told), told->reason.empty() ? "" : " (" + told->reason + ")");
}

void AttemptWatch::add_phases(AttemptView& view) const {
  if (!phases_) return;
  const std::vector<tasks::Phase>& phases = case_->task.phases;
  for (std::size_t n = 0; n < phases.size(); ++n) {
    const scoring::PhaseState& state = phases_->states()[n];
    PhaseView shown{phases[n].title, phases[n].why, {}, state.is_open, state.begun_s, state.done_s};
    if (!state.lacks.empty()) {
      shown.lacks = state.lacks.front();
      shown.lacks.front() = ascii::to_upper(shown.lacks.front());
    }
    view.phases.push_back(std::move(shown));
  }
  view.current_phase = phases_->current();
}

std::string AttemptWatch::hint(const AttemptView& view, const telemetry::TickSample& needle) const {
  const bool is_outside = needle.phase == telemetry::InsertionPhase::kOutside;
  if (view.current_phase && view.probe.is_known && plane_ && is_outside && view.shots == 0 &&
      is_step_of_transducer(case_->task.phases[*view.current_phase])) {
    const Segment& path_P = case_->plan.line_P;
    const Vec3 target_A = path_P.b + case_->needle.notch_middle_mm() * path_P.direction();
    return guide_transducer(*case_->patient, view.motion, target_A, view.probe.X_PT, view.probe.contact_n, *plane_);
  }
  GuideState state{cores_, view.is_gun_loaded, shot_.get()};
  for (const tasks::Action& action : record_->actions())
    state.is_confirmed = state.is_confirmed || (case_->task.confirmed_by != tasks::Substance::kNothing &&
                                                action.result.substance == case_->task.confirmed_by);
  state.are_steps_done = phases_ && !phases_->states().empty() && !phases_->current();
  return guide_puncture(*case_, needle, state);
}

std::vector<ForcePoint> AttemptWatch::take_forces(bool is_last) {
  if (is_last) trace_.flush();
  return trace_.take();
}

}  // namespace trocar::attempt
