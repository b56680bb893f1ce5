// What a client sees of an attempt.
#include "attempt/guide/needle_view.h"
#include "attempt/live/attempt_loop.h"
#include "haptics/option_texts.h"
#include "metrics/metric.h"
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
  if (is_preparing()) return AttemptPhase::kStarting;
  if (!needle_.server->is_fresh()) return AttemptPhase::kServerLost;
  const bool is_inside = needle_.last && (needle_.last->phase == telemetry::InsertionPhase::kInserted ||
                                          needle_.last->phase == telemetry::InsertionPhase::kRetracting ||
                                          needle_.last->depth_mm > case_.the_case->tissues.skin_thickness_mm);
  return is_inside ? AttemptPhase::kInBody : AttemptPhase::kReady;
}

motion::PatientMotion AttemptLoop::motion_now() {
  const motion::MotionModel* const model = case_.the_case->patient->motion.get();
  if (model == nullptr || !needle_.last) return {};
  const KnownScenes& scenes = needle_.server->scenes();
  if (const SceneParameters* newest = scenes.newest(); newest != nullptr && scenes.newest_number() != drive_scene_) {
    haptics::HapticOptions options;
    stylus::DeviceCapability device;
    if (haptics::restore_options(newest->options, options, device)) drive_ = options.motion;
    drive_scene_ = scenes.newest_number();
  }
  return metrics::recorded_motion(motion::moves(drive_) ? model : nullptr, *needle_.last);
}

NeedleView AttemptLoop::needle_now() const {
  NeedleView view;
  if (needle_.last) {
    const bool is_led = follows_targets(needle_.server->host().device());
    view = needle_view(*case_.the_case, *needle_.last, needle_shape_,
                       is_led ? command_.X_PN : telemetry::device_pose(*needle_.last));
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
  if (!transducer_.last) return view;
  view.is_known = true;
  view.X_PT = telemetry::felt_probe(*transducer_.last);
  if (!follows_targets(transducer_.server->host().device())) view.X_PT_goal = telemetry::device_pose(*transducer_.last);
  view.contact_n = transducer_.last->f_constraint_n.norm();
  view.pressed_mm = transducer_.last->depth_mm;
  return view;
}

void AttemptLoop::add_servers(AttemptView& view) const {
  view.are_forces_stopped = is_stopped_;
  for (const LiveTool* tool : {&transducer_, &needle_}) {  // the needle's banner has priority
    if (!tool->server) continue;
    ServerView& shown = view.servers[tool == &needle_ ? 0 : 1];
    shown = tool->server->view();
    view.are_forces_stopped = view.are_forces_stopped || shown.waits_for_resume;
    if (!tool->server->banner().empty()) view.banner = tool->server->banner();
  }
  if (view.banner.empty() && recording() != nullptr) view.banner = recording()->disk_banner;
  if (is_stopped_ && view.banner.empty()) view.banner = "Forces are stopped. Resume to continue.";
}

AttemptUpdate AttemptLoop::compose(AttemptPhase phase, Activity activity) {
  AttemptUpdate update;
  update.servers = servers_;
  AttemptView& view = update.view;
  view.phase = phase;
  view.progress = std::move(activity.step);
  view.progress_fraction = activity.fraction;
  Recording* const now = recording();
  if (!options_.has_view) {
    if (now != nullptr) view.needle.time_s = now->live.time_s();
    return update;
  }
  view.message = message_;
  view.recovered = recovered_;
  view.recoveries = recoveries_;
  view.motion = motion_now();
  view.needle = needle_now();
  view.probe = transducer_now();
  view.has_probe = transducer_.server != nullptr;
  view.is_performing = steering_->is_performing();
  view.notes = notes_;
  add_servers(view);
  if (now == nullptr || !now->watch || !needle_.last) return update;
  const bool is_moving = phase == AttemptPhase::kReady || phase == AttemptPhase::kInBody;
  now->watch->step(*needle_.last, transducer_.last ? &*transducer_.last : nullptr, view.motion);
  now->watch->add_to(view, *needle_.last, now->live.active_s(), options_.level);
  if (options_.is_guided && is_moving) view.hint = now->watch->hint(view, *needle_.last);
  update.forces = now->watch->take_forces(phase == AttemptPhase::kFinishing);
  update.events = now->watch->take_events();
  return update;
}

}  // namespace trocar::attempt
