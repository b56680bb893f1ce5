// What a client sees of an attempt.
#include <fmt/format.h>

#include <limits>

#include "attempt/guide/needle_view.h"
#include "attempt/guide/puncture_guide.h"
#include "attempt/live/attempt_loop.h"
#include "core/text.h"
#include "haptics/scene_options.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

const char* to_string(AttemptPhase phase) noexcept {
  switch (phase) {
    case AttemptPhase::kStarting:
      return "starting";
    case AttemptPhase::kReady:
      return "ready";
    case AttemptPhase::kInBody:
      return "in the body";
    case AttemptPhase::kServerLost:
      return "server lost";
    case AttemptPhase::kStopped:
      return "forces stopped";
    case AttemptPhase::kFinishing:
      return "finishing";
    case AttemptPhase::kFinished:
      return "finished";
    case AttemptPhase::kFailed:
      return "failed";
  }
  return "?";
}

AttemptView aged(AttemptView view, double age_s) {
  constexpr double kFresh_s = 0.25;
  const bool moves = view.phase == AttemptPhase::kReady || view.phase == AttemptPhase::kInBody;
  if (!moves || age_s < kFresh_s) return view;
  view.phase = AttemptPhase::kServerLost;
  view.banner = "The puncture is paused: this machine is too busy";
  view.hint.clear();
  return view;
}

AttemptPhase AttemptLoop::phase_now() const {
  if (is_stopped_) return AttemptPhase::kStopped;
  if (!has_ever_been_on_) return AttemptPhase::kStarting;
  if (!needle_->is_fresh()) return AttemptPhase::kServerLost;
  const bool is_inside = last_needle_ && (last_needle_->phase == telemetry::InsertionPhase::kInserted ||
                                          last_needle_->phase == telemetry::InsertionPhase::kRetracting ||
                                          last_needle_->depth_mm > case_.the_case->tissues.skin_thickness_mm);
  return is_inside ? AttemptPhase::kInBody : AttemptPhase::kReady;
}

motion::PatientMotion AttemptLoop::motion_now() {
  const motion::MotionModel* const model = case_.the_case->patient->motion.get();
  if (model == nullptr || !last_needle_) return {};
  const KnownScenes& scenes = needle_->scenes();
  if (const SceneParameters* newest = scenes.newest(); newest != nullptr && scenes.newest_number() != drive_scene_) {
    haptics::HapticOptions options;
    stylus::DeviceCapability device;
    if (haptics::restore_options(newest->options, options, device)) drive_ = options.motion;
    drive_scene_ = scenes.newest_number();
  }
  return {model, motion::state_of_phase(drive_, last_needle_->breathing, last_needle_->time_s)};
}

NeedleView AttemptLoop::needle_now() const {
  NeedleView view;
  if (last_needle_) {
    const bool is_led = follows_targets(needle_->host().device());
    view = needle_view(*case_.the_case, *last_needle_, needle_shape_,
                       is_led ? command_.X_PN : telemetry::device_pose(*last_needle_));
  } else {
    view.X_PN = view.X_PN_goal = command_.X_PN;
  }
  view.is_clamped = steering_->hand().is_clamped();
  return view;
}

TransducerView AttemptLoop::transducer_now() const {
  TransducerView view;
  const LedPose& hand = led_transducer_.hand();
  view.X_PT_goal = view.X_PT = hand.X_P();
  view.is_clamped = hand.is_clamped();
  if (!last_transducer_) return view;
  view.is_known = true;
  view.X_PT = telemetry::felt_probe(*last_transducer_);
  if (!follows_targets(transducer_->host().device())) view.X_PT_goal = telemetry::device_pose(*last_transducer_);
  view.contact_n = last_transducer_->f_constraint_n.norm();
  view.pressed_mm = last_transducer_->depth_mm;
  return view;
}

void AttemptLoop::add_servers(AttemptView& view) const {
  view.are_forces_stopped = is_stopped_;
  for (const ServerSupervisor* server : {transducer_.get(), needle_.get()}) {  // the needle's banner has priority
    if (server == nullptr) continue;
    ServerView& shown = view.servers[server == needle_.get() ? 0 : 1];
    shown = server->view();
    view.are_forces_stopped = view.are_forces_stopped || shown.waits_for_resume;
    if (!server->banner().empty()) view.banner = server->banner();
  }
  if (view.banner.empty()) view.banner = disk_banner_;
  if (is_stopped_ && view.banner.empty()) view.banner = "Forces are stopped. Resume to continue.";
}

void AttemptLoop::step_phases() {
  constexpr double kEvery_s = 0.02;
  if (!phases_ || !last_needle_ || !live_) return;
  if (last_needle_->time_s < phases_s_ + kEvery_s) return;
  phases_s_ = last_needle_->time_s;
  scoring::PhaseMoment moment;
  moment.needle = *last_needle_;
  if (last_transducer_) {
    moment.X_PT = telemetry::felt_probe(*last_transducer_);
    moment.contact_n = last_transducer_->f_constraint_n.norm();
  }
  moment.contrast_ml = contrast_ml_;
  moment.cores = cores_;
  phases_->step(moment);
}

void AttemptLoop::add_phases(AttemptView& view) const {
  if (record_) {
    const tasks::Action* wire = tasks::find_wire(record_->actions(), std::numeric_limits<double>::infinity());
    if (wire != nullptr) view.wire_mm = wire->amount;
    for (const tasks::Action& action : record_->actions()) {
      if (action.kind == tasks::ActionKind::kDrawStylet) view.is_stylet_drawn = true;
      if (action.kind == tasks::ActionKind::kReplaceStylet) view.is_stylet_drawn = false;
      if (action.kind == tasks::ActionKind::kHoldBreath) view.is_breath_held = true;
      if (action.kind == tasks::ActionKind::kBreathe) view.is_breath_held = false;
    }
  }
  if (!phases_ || options_.level == "exam") return;
  const std::vector<tasks::Phase>& phases = case_.the_case->task.phases;
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

/// At once, as long as the needle is in the structure, and for long enough to be read; an exam tells it at its end.
void AttemptLoop::add_harm(AttemptView& view) const {
  constexpr double kShown_s = 6.0;
  const bool is_fresh = told_harm_ && last_needle_ && last_needle_->time_s - told_harm_s_ < kShown_s;
  const metrics::HarmEvent* present = harm_ ? harm_->present() : nullptr;
  if (present != nullptr && present->grade < tasks::Harm::kMajor) present = nullptr;
  const metrics::HarmEvent* told = present != nullptr ? present : is_fresh ? &*told_harm_ : nullptr;
  if (told == nullptr || !view.banner.empty() || options_.level == "exam") return;
  view.is_harm = true;
  view.banner = fmt::format("{} harm: {}{}. Pull back.", told->grade == tasks::Harm::kCritical ? "Critical" : "Major",
                            metrics::harm_words(*told), told->reason.empty() ? "" : " (" + told->reason + ")");
}

void AttemptLoop::add_times(AttemptView& view) {
  if (!last_needle_) return;
  if (live_) session_s_ = live_->active_s();
  if (contact_s_ && record_)
    since_contact_s_ = tasks::active_time_s(*contact_s_, last_needle_->time_s, record_->interruptions());
  view.session_s = session_s_;
  view.since_contact_s = since_contact_s_;
  view.shot = shot_;
  if (shot_) view.since_shot_s = last_needle_->time_s - shot_->time_s;
}

/// About the transducer in a step that it does, as long as the needle is outside.
std::string AttemptLoop::hint_of(const AttemptView& view) const {
  const cases::Case& the_case = *case_.the_case;
  const bool is_outside = last_needle_->phase == telemetry::InsertionPhase::kOutside;
  if (view.current_phase && view.probe.is_known && case_.plane && is_outside && view.shots == 0 &&
      is_step_of_transducer(the_case.task.phases[*view.current_phase])) {
    const Segment& path_P = the_case.plan.line_P;
    const Vec3 target_P = path_P.b + the_case.needle.notch_middle_mm() * path_P.direction();
    return guide_transducer(*the_case.patient, target_P, view.probe.X_PT, view.probe.contact_n, *case_.plane);
  }
  GuideState state{cores_, view.is_gun_loaded, shot_.get()};
  if (record_)
    for (const tasks::Action& action : record_->actions())
      state.is_confirmed = state.is_confirmed || (the_case.task.confirmed_by != tasks::Substance::kNothing &&
                                                  action.result.substance == the_case.task.confirmed_by);
  state.are_steps_done = phases_ && !phases_->states().empty() && !phases_->current();
  return guide_puncture(the_case, *last_needle_, state);
}

void AttemptLoop::publish(AttemptPhase phase, std::optional<Result<RunResult>> result) {
  AttemptUpdate update;
  update.result = std::move(result);
  update.servers = servers_;
  AttemptView& view = update.view;
  view.phase = phase;
  view.progress = progress_;
  view.progress_fraction = progress_fraction_;
  if (!options_.has_view) {
    if (live_) view.needle.time_s = live_->time_s();
    exchange_.publish(std::move(update));
    return;
  }
  view.message = message_;
  view.recovered = recovered_;
  view.recoveries = recoveries_;
  view.motion = motion_now();
  view.needle = needle_now();
  view.probe = transducer_now();
  view.has_probe = transducer_ != nullptr;
  view.is_performing = steering_->is_performing();
  if (record_) {
    view.shots = record_->shots().size();
    view.is_gun_loaded = tasks::is_gun_loaded(record_->actions());
  }
  view.notes = notes_;
  add_servers(view);
  add_harm(view);
  add_times(view);
  step_phases();
  add_phases(view);
  const bool is_moving = phase == AttemptPhase::kReady || phase == AttemptPhase::kInBody;
  if (options_.is_guided && is_moving && last_needle_) view.hint = hint_of(view);
  update.forces = trace_.take();
  update.events = std::exchange(events_, {});
  exchange_.publish(std::move(update));
}

}  // namespace trocar::attempt
