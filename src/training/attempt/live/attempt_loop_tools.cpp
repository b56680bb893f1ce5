// What an attempt does with the ticks of its tools.
#include <fmt/format.h>

#include <algorithm>

#include "attempt/guide/needle_view.h"
#include "attempt/live/attempt_loop.h"
#include "attempt/live/attempt_view.h"
#include "attempt/record/session_case.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

/// Ticks that are older when they arrive were not answered in time: a server's hand stops when it gets no target for so
/// long, and the operator's must not have moved on meanwhile.
constexpr double kAnswered_s = 0.05;

}  // namespace

Status AttemptLoop::step_needle() {
  const std::vector<link::NumberedSample> samples = needle_->take_samples();
  if (samples.empty()) {
    was_needle_on_ = was_needle_on_ && needle_->is_fresh();
    return {};
  }
  if (!was_needle_on_) {
    if (live_) live_->begin(needle_->client().clock_offset_s, needle_->activations() != needle_activations_);
    needle_activations_ = needle_->activations();
    if (has_ever_been_on_) steering_->resume_at(telemetry::device_pose(samples.front().sample));
    needle_time_s_ = samples.front().sample.time_s;
  }
  was_needle_on_ = true;
  note_place(samples.back().sample);
  if (!live_) {
    answer_unrecorded(samples);
    return {};
  }
  TROCAR_TRY_STATUS(record(samples));
  needle_->set_target(live_->hand());
  send_scheduled_parameters();
  return {};
}

/// Where the needle is placed if its server is prepared again. The largest depression of this insertion counts: an
/// interruption may come before the hand is back from the last one.
void AttemptLoop::note_place(const telemetry::TickSample& sample) {
  const bool is_outside = sample.phase == telemetry::InsertionPhase::kOutside;
  telemetry::NeedlePlace place = telemetry::needle_place(sample);
  place.pressed_mm = pressed_mm_ = is_outside ? 0.0 : std::max(pressed_mm_, place.pressed_mm);
  needle_->place_at(place);
}

void AttemptLoop::answer_unrecorded(const std::vector<link::NumberedSample>& samples) {
  // A scripted operator begins with the record; until then the needle rests where it was put.
  const bool is_resting = steering_->is_scripted();
  tasks::OperatorView view;
  for (const link::NumberedSample& numbered : samples) {
    view.last = numbered.sample;
    view.dt_s = std::clamp(numbered.sample.time_s - needle_time_s_, 0.0, kLongestHandStep_s);
    view.X_PN_device = telemetry::device_pose(numbered.sample);
    needle_time_s_ = numbered.sample.time_s;
    if (numbered.shape) needle_shape_ = *numbered.shape;
    if (!is_resting) command_ = performer_.the_operator->next(view);
  }
  last_needle_ = samples.back().sample;
  last_needle_->time_s = 0.0;
  if (!is_resting) needle_->set_target(hand_target(command_, needle_time_s_ + 1.0 / performer_.rate_hz));
}

Status AttemptLoop::record(const std::vector<link::NumberedSample>& samples) {
  for (const link::NumberedSample& numbered : samples) {
    bool goes_on = true;
    if (numbered.sample.time_s < samples.back().sample.time_s - kAnswered_s) {
      TROCAR_TRY_STATUS(live_->take_unseen(numbered.sample));
    } else {
      TROCAR_TRY(goes_on, live_->take(numbered.sample));
    }
    TROCAR_TRY_STATUS(record_->note_scene(numbered.scene, needle_->scenes()));
    TROCAR_TRY_STATUS(note_shape(numbered));
    note_tick(live_->last());
    finishes_ = finishes_ || !goes_on;
    if (!goes_on) break;
  }
  note_shots();
  note_actions();
  command_ = live_->command();
  last_needle_ = live_->last();
  return {};
}

Status AttemptLoop::note_shape(const link::NumberedSample& numbered) {
  if (!numbered.shape) return {};
  needle_shape_ = *numbered.shape;
  needle_shape_.time_s = live_->last().time_s;
  return record_->append(needle_shape_);
}

void AttemptLoop::note_tick(const telemetry::TickSample& sample) {
  if (!options_.has_view) return;
  trace_.add({sample.time_s, sample.depth_mm, telemetry::axial_resistance_n(sample)});
  if (!contact_s_ && sample.phase != telemetry::InsertionPhase::kOutside) contact_s_ = sample.time_s;
  for (const telemetry::TickEvent& event : sample.events) {
    if (event.kind == telemetry::EventKind::kNone) break;
    if (auto described = describe_event(record_->info(), sample, event)) events_.push_back(*std::move(described));
  }
  if (const auto pain = pain_ ? pain_->step(sample) : std::nullopt) events_.push_back(describe_pain(*pain));
  if (!harm_) return;
  harm_->step(metrics::moment_of(sample));
  note_harm(sample);
}

void AttemptLoop::note_harm(const telemetry::TickSample& sample) {
  for (const metrics::HarmEvent& event : harm_->take_news()) {
    events_.push_back(describe_harm(event, sample));
    if (event.grade < tasks::Harm::kMajor) continue;
    told_harm_ = event;
    told_harm_s_ = sample.time_s;
  }
}

void AttemptLoop::note_shots() {
  const std::vector<std::size_t>& shots = record_->shots();
  if (!options_.has_view) return;
  for (; told_shots_ < shots.size(); ++told_shots_) {
    const telemetry::TickSample& fired = record_->samples()[shots[told_shots_]];
    shot_ = std::make_shared<const GunShot>(make_gun_shot(*case_.the_case, fired));
    if (!shot_->pieces.empty()) ++cores_;
    // The composition of the core is displayed beside its picture.
    events_.push_back({shot_->time_s, shot_->depth_mm, telemetry::EventKind::kNone, "shot",
                       shot_->is_in_body() ? fmt::format("the gun was fired at {:.0f}\u00a0mm", shot_->depth_mm)
                                           : "the gun was fired outside the body"});
    if (!harm_) continue;
    harm_->fire(metrics::moment_of(fired));
    note_harm(fired);
  }
}

void AttemptLoop::note_contrast(const tasks::XrayUse& use) {
  const double ml = use.contrast_ml - contrast_ml_;
  contrast_ml_ = use.contrast_ml;
  if (!(ml > 0.0)) return;
  if (!injection_) injection_.emplace();
  injection_->end_s = use.time_s;
  injection_->ml += ml;
  injection_->total_ml = use.contrast_ml;
}

void AttemptLoop::tell_injection() {
  if (!injection_ || !live_ || live_->time_s() - injection_->end_s < tasks::kBetweenInjections_s) return;
  const double depth_mm = last_needle_ ? last_needle_->depth_mm : 0.0;
  if (options_.has_view) events_.push_back(describe_injection(*injection_, depth_mm));
  injection_.reset();
}

void AttemptLoop::note_actions() {
  const std::vector<tasks::Action>& actions = record_->actions();
  for (; told_actions_ < actions.size(); ++told_actions_) {
    if (phases_) phases_->note(actions[told_actions_]);
    if (pain_) pain_->note(actions[told_actions_]);
    if (harm_) harm_->note(actions[told_actions_]);
    const bool is_told = actions[told_actions_].kind != tasks::ActionKind::kFire;  // told as a shot
    if (options_.has_view && is_told)
      events_.push_back(
          describe_action(case_.the_case->substances, actions[told_actions_], case_.the_case->patient.get()));
  }
}

/// Parameters of a replayed session, sent when as many ticks were made as before them. The server replies from which
/// tick they apply.
void AttemptLoop::send_scheduled_parameters() {
  const auto& all = performer_.parameters;
  while (next_parameters_ < all.size() && all[next_parameters_].tick <= record_->samples().size())
    needle_->set_parameters(as_command(all[next_parameters_++]));
}

Status AttemptLoop::step_transducer() {
  const std::vector<link::NumberedSample> samples = transducer_->take_samples();
  if (samples.empty()) {
    was_transducer_on_ = was_transducer_on_ && transducer_->is_fresh();
    return {};
  }
  const double first_s = samples.front().sample.time_s, now_s = samples.back().sample.time_s;
  if (!was_transducer_on_) transducer_time_s_ = first_s;
  if (transducer_->activations() != transducer_activations_) transducer_on_s_ = first_s;
  transducer_activations_ = transducer_->activations();
  was_transducer_on_ = true;
  link::HandTarget target =
      transducer_motion_->next(now_s - transducer_on_s_, std::min(now_s - transducer_time_s_, kAnswered_s));
  target.server_time_s = now_s;
  transducer_time_s_ = now_s;
  last_transducer_ = samples.back().sample;
  transducer_->set_target(target);
  transducer_->place_at(transducer_motion_->X_PT_to_resume(*last_transducer_));
  return live_ ? live_->note_transducer(samples, transducer_->client().clock_offset_s) : Status{};
}

}  // namespace trocar::attempt
