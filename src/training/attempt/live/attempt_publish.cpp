// Builds the view of an attempt for the window.
#include "attempt/guide/gun_shot.h"
#include "attempt/guide/needle_view.h"
#include "attempt/guide/puncture_guide.h"
#include "attempt/live/attempt_loop.h"
#include "telemetry/tick_pose.h"

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
  if (!needle_->is_on()) return AttemptPhase::kServerLost;
  const bool is_inside = last_needle_ && (last_needle_->phase == telemetry::InsertionPhase::kInserted ||
                                          last_needle_->phase == telemetry::InsertionPhase::kRetracting ||
                                          last_needle_->depth_mm > open_case_->the_case.tissues.skin_thickness_mm);
  return is_inside ? AttemptPhase::kInBody : AttemptPhase::kReady;
}

NeedleView AttemptLoop::needle_now() const {
  NeedleView view;
  if (last_needle_) {
    const bool is_led = device_hold(options_.device_needle) == DeviceHold::kOurHand;
    view = needle_view(open_case_->the_case, *last_needle_,
                       is_led ? command_.X_PN : telemetry::device_pose(*last_needle_));
  } else {
    view.X_PN = view.X_PN_device = view.X_PN_hand = command_.X_PN;
  }
  view.is_clamped = steering_->hand().is_clamped();
  return view;
}

TransducerView AttemptLoop::probe_now() const {
  TransducerView view;
  view.X_PT_hand = view.X_PT = probe_hand_.X_P();
  view.is_clamped = probe_hand_.is_clamped();
  if (!last_probe_) return view;
  view.is_known = true;
  view.X_PT = telemetry::felt_probe(*last_probe_);
  if (device_hold(options_.device_probe) != DeviceHold::kOurHand) view.X_PT_hand = telemetry::device_pose(*last_probe_);
  view.contact_n = last_probe_->f_constraint_n.norm();
  view.pressed_mm = last_probe_->depth_mm;
  return view;
}

void AttemptLoop::publish(AttemptPhase phase, std::optional<Result<RunResult>> result) {
  AttemptView view;
  view.phase = phase;
  view.progress = progress_;
  view.progress_fraction = progress_fraction_;
  view.message = message_;
  view.recovered = recovered_;
  view.recoveries = recoveries_;
  view.needle = needle_now();
  view.probe = probe_now();
  view.has_probe = probe_.has_value();
  view.is_performing = steering_->is_performing();
  view.has_fired = steering_->has_fired();
  view.notes = notes_;
  view.are_forces_stopped = is_stopped_;
  for (const std::optional<ToolServer>* server : {&probe_, &needle_}) {  // the needle's banner has priority
    if (!*server) continue;
    ServerView& shown = view.servers[server == &needle_ ? 0 : 1];
    shown = (*server)->view();
    view.are_forces_stopped = view.are_forces_stopped || shown.waits_for_resume;
    if (!(*server)->banner().empty()) view.banner = (*server)->banner();
  }
  if (view.banner.empty()) view.banner = disk_banner_;
  if (is_stopped_ && view.banner.empty()) view.banner = "Forces are stopped. Resume to continue.";
  if (last_needle_) {
    if (live_) session_s_ = live_->active_s();
    if (contact_s_ && record_)
      since_contact_s_ = tasks::active_time_s(*contact_s_, last_needle_->time_s, record_->interruptions());
    view.session_s = session_s_;
    view.shot = shot_;
    if (shot_) view.since_shot_s = last_needle_->time_s - shot_->time_s;
    view.since_contact_s = since_contact_s_;
    const bool is_moving = phase == AttemptPhase::kReady || phase == AttemptPhase::kInBody;
    if (options_.is_guided && is_moving)
      view.hint = guide_puncture(open_case_->the_case, *last_needle_, view.has_fired);
  }
  std::vector<ForcePoint> forces = trace_.take();
  constexpr std::size_t kMostKept = 100'000;  // if a window does not take them

  const std::lock_guard lock(desk_.mutex);
  AttemptNews& news = desk_.news;
  view.is_performing = view.is_performing || desk_.wishes.performer != nullptr;
  news.view = std::move(view);
  news.told = options_.clock->now();
  news.servers = servers_;
  if (news.forces.size() < kMostKept) news.forces.insert(news.forces.end(), forces.begin(), forces.end());
  if (news.events.size() < kMostKept) news.events.insert(news.events.end(), events_.begin(), events_.end());
  events_.clear();
  if (result) news.result = std::move(result);
}

}  // namespace trocar::attempt
