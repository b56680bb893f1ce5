#include "headless/live_operator.h"

#include <algorithm>

#include "telemetry/tick_pose.h"
#include "training/hand.h"

namespace trocar {
namespace {

constexpr double kLongestStep_s = 0.02;  // of a hand: a longer gap between ticks is a pause, not a motion

/// The server resumed the needle while the hand was being placed, in ticks that are not recorded.
void note_resumption(TickSample& sample) noexcept {
  if (sample.phase == InsertionPhase::kOutside) return;
  for (TickEvent& event : sample.events) {
    if (event.kind != EventKind::kNone) continue;
    event = {EventKind::kLimit, static_cast<std::uint8_t>(LimitReason::kResumedInside)};
    return;
  }
}

}  // namespace

HandTarget hand_target(const HandCommand& command, double server_time_s) noexcept {
  const HandSpring spring = hand_spring(HandParams{}, command);
  HandTarget target;
  target.X_PN = command.X_PN;
  target.v_P = spring.anchor_velocity_P;
  target.server_time_s = server_time_s;
  target.stiffness_n_per_mm = spring.stiffness_n_per_mm;
  target.damping_ns_per_mm = spring.damping_ns_per_mm;
  target.mass_kg = spring.mass_kg;
  target.holds_tip = true;
  target.is_rigid = command.is_rigid;
  return target;
}

LiveOperator::LiveOperator(const Performer& performer, AttemptRecord& record, const HandCommand& first,
                           double longest_s)
    : performer_(&performer),
      record_(&record),
      command_(first),
      period_s_(1.0 / performer.rate_hz),
      longest_s_(longest_s) {
  view_.X_PN_device = first.X_PN;
  record.note(first);
}

void LiveOperator::begin(double clock_offset_s) noexcept {
  offset_s_ = clock_offset_s;
  is_seated_anew_ = true;
}

Result<double> LiveOperator::record(const TickSample& tick) {
  server_time_s_ = tick.time_s;
  if (!has_begun_) origin_s_ = tick.time_s - offset_s_;
  view_.last = tick;
  if (has_begun_ && is_seated_anew_) note_resumption(view_.last);
  double step_s = has_begun_ ? std::max(0.0, tick.time_s - offset_s_ - origin_s_ - time_s_) : 0.0;
  has_begun_ = true;
  time_s_ += step_s;
  if (is_seated_anew_) {
    paused_s_ += std::max(0.0, step_s - period_s_);
    step_s = period_s_;
  }
  is_seated_anew_ = false;
  view_.last.time_s = time_s_;
  view_.X_PN_device = device_pose(tick);
  TROCAR_TRY_STATUS(record_->append(view_.last));
  return step_s;
}

Result<bool> LiveOperator::take(const TickSample& tick) {
  TROCAR_TRY(const double step_s, record(tick));
  view_.time_s += step_s;
  view_.dt_s = std::min(step_s, kLongestStep_s);
  command_ = performer_->the_operator->next(view_);
  if (command_.is_done || time_s_ > longest_s_) return false;
  record_->note(command_);
  return true;
}

Status LiveOperator::take_unseen(const TickSample& tick) {
  TROCAR_TRY(const double step_s, record(tick));
  unseen_s_ += step_s;
  return {};
}

Status LiveOperator::note_transducer(std::span<const NumberedSample> ticks, double clock_offset_s) {
  if (!has_begun_) return {};
  for (const NumberedSample& numbered : ticks) {
    const TickSample& tick = numbered.sample;
    const double at_s = tick.time_s - clock_offset_s - origin_s_;
    if (at_s < 0.0) continue;
    TROCAR_TRY_STATUS(record_->append(TransducerSample{at_s, felt_probe(tick), tick.f_constraint_n.norm()}));
  }
  return {};
}

HandTarget LiveOperator::hand() const noexcept {
  return hand_target(command_, server_time_s_ + period_s_);
}

}  // namespace trocar
