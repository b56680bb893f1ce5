// What an attempt does with the ticks of its tools.
#include <algorithm>

#include "attempt/live/attempt_loop.h"
#include "attempt/record/session_case.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

/// Ticks that are older when they arrive were not answered in time: a server's hand stops when it gets no target for so
/// long, and the operator's must not have moved on meanwhile.
constexpr double kAnswered_s = 0.05;

}  // namespace

Status AttemptLoop::step_needle() {
  ServerSupervisor& server = *needle_.server;
  const std::vector<link::NumberedSample> samples = server.take_samples();
  if (samples.empty()) {
    needle_.was_on = needle_.was_on && server.is_fresh();
    return {};
  }
  Recording* const now = recording();
  if (!needle_.was_on) {
    const bool is_placed_anew = server.activations() != needle_.activations;
    needle_.activations = server.activations();
    needle_.time_s = samples.front().sample.time_s;
    if (now != nullptr) now->live.begin(server.client().clock_offset_s, is_placed_anew);
    if (now != nullptr) steering_->resume_at(telemetry::device_pose(samples.front().sample));
  }
  needle_.was_on = true;
  note_place(samples.back().sample);
  if (now == nullptr) {
    answer_unrecorded(samples);
    return {};
  }
  TROCAR_TRY_STATUS(record(*now, samples));
  server.set_target(now->live.hand());
  send_scheduled_parameters(now->record);
  return {};
}

/// Where the needle is placed if its server is prepared again. The largest depression of this insertion counts: an
/// interruption may come before the hand is back from the last one.
void AttemptLoop::note_place(const telemetry::TickSample& sample) {
  const bool is_outside = sample.phase == telemetry::InsertionPhase::kOutside;
  telemetry::NeedlePlace place = telemetry::needle_place(sample);
  place.pressed_mm = pressed_mm_ = is_outside ? 0.0 : std::max(pressed_mm_, place.pressed_mm);
  needle_.server->place_at(place);
}

void AttemptLoop::answer_unrecorded(const std::vector<link::NumberedSample>& samples) {
  // A scripted operator begins with the record; until then the needle rests where it was put.
  const bool is_resting = steering_->is_scripted();
  tasks::OperatorView view;
  for (const link::NumberedSample& numbered : samples) {
    view.last = numbered.sample;
    view.dt_s = std::clamp(numbered.sample.time_s - needle_.time_s, 0.0, kLongestHandStep_s);
    view.X_PN_device = telemetry::device_pose(numbered.sample);
    needle_.time_s = numbered.sample.time_s;
    if (numbered.shape) needle_shape_ = *numbered.shape;
    if (!is_resting) command_ = performer_.the_operator->next(view);
  }
  needle_.last = samples.back().sample;
  needle_.last->time_s = 0.0;
  if (!is_resting) needle_.server->set_target(hand_target(command_, needle_.time_s + 1.0 / performer_.rate_hz));
}

Status AttemptLoop::record(Recording& recording, const std::vector<link::NumberedSample>& samples) {
  LiveOperator& live = recording.live;
  for (const link::NumberedSample& numbered : samples) {
    bool goes_on = true;
    if (numbered.sample.time_s < samples.back().sample.time_s - kAnswered_s) {
      TROCAR_TRY_STATUS(live.take_unseen(numbered.sample));
    } else {
      TROCAR_TRY(goes_on, live.take(numbered.sample));
      if (goes_on && live.command().action) ask_patient(live.command().action->kind);
    }
    TROCAR_TRY_STATUS(recording.record.note_scene(numbered.scene, needle_.server->scenes()));
    if (numbered.shape) {
      needle_shape_ = *numbered.shape;
      needle_shape_.time_s = live.last().time_s;
      TROCAR_TRY_STATUS(recording.record.append(needle_shape_));
    }
    if (recording.watch) recording.watch->take(live.last());
    finishes_ = finishes_ || !goes_on;
    if (!goes_on) break;
  }
  if (recording.watch) recording.watch->take_actions();
  command_ = live.command();
  needle_.last = live.last();
  return {};
}

/// Parameters of a replayed session, sent when as many ticks were made as before them. The server replies from which
/// tick they apply.
void AttemptLoop::send_scheduled_parameters(const AttemptRecord& record) {
  const auto& all = performer_.parameters;
  while (next_parameters_ < all.size() && all[next_parameters_].tick <= record.samples().size())
    needle_.server->set_parameters(as_command(all[next_parameters_++]));
}

Status AttemptLoop::step_transducer() {
  ServerSupervisor& server = *transducer_.server;
  const std::vector<link::NumberedSample> samples = server.take_samples();
  if (samples.empty()) {
    transducer_.was_on = transducer_.was_on && server.is_fresh();
    return {};
  }
  const double first_s = samples.front().sample.time_s, now_s = samples.back().sample.time_s;
  if (!transducer_.was_on) transducer_.time_s = first_s;
  if (server.activations() != transducer_.activations) transducer_on_s_ = first_s;
  transducer_.activations = server.activations();
  transducer_.was_on = true;
  link::HandTarget target =
      transducer_motion_->next(now_s - transducer_on_s_, std::min(now_s - transducer_.time_s, kAnswered_s));
  target.server_time_s = now_s;
  transducer_.time_s = now_s;
  transducer_.last = samples.back().sample;
  server.set_target(target);
  server.place_at(transducer_motion_->X_PT_to_resume(*transducer_.last));
  return recording() != nullptr ? recording()->live.note_transducer(samples, server.client().clock_offset_s) : Status{};
}

}  // namespace trocar::attempt
