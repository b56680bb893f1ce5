#include "attempt/live/live_operator.h"

#include <algorithm>
#include <utility>

#include "stylus/virtual_stylus.h"
#include "tasks/operator.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

constexpr double kLongestGap_s = 0.1;  // between two ticks: a longer gap is time without control

/// The server resumed the needle while placing the hand, in ticks that are not recorded.
void note_resumption(telemetry::TickSample& sample) noexcept {
  if (sample.phase == telemetry::InsertionPhase::kOutside) return;
  for (telemetry::TickEvent& event : sample.events) {
    if (event.kind != telemetry::EventKind::kNone) continue;
    event = {telemetry::EventKind::kLimit, static_cast<std::uint8_t>(telemetry::LimitReason::kResumedInside)};
    return;
  }
}

}  // namespace

link::HandTarget hand_target(const tasks::HandCommand& command, double server_time_s) noexcept {
  const tasks::HandSpring spring = tasks::hand_spring(tasks::HandParams{}, command);
  link::HandTarget target;
  target.X_PN = command.X_PN;
  target.v_P = spring.anchor_velocity_P;
  target.server_time_s = server_time_s;
  target.stiffness_n_per_mm = spring.stiffness_n_per_mm;
  target.damping_ns_per_mm = spring.damping_ns_per_mm;
  target.mass_kg = spring.mass_kg;
  target.holds_tip = true;
  const stylus::StylusHold guiding = stylus::make_guiding_hand(0.0);  // the server knows the tip's position
  target.turning_nmm_per_rad = guiding.turning_nmm_per_rad;
  target.turning_damping_nmms_per_rad = guiding.turning_damping_nmms_per_rad;
  target.is_rigid = command.is_rigid;
  return target;
}

LiveOperator::LiveOperator(const Performer& performer, AttemptRecord& record, const tasks::HandCommand& first,
                           double longest_s)
    : performer_(&performer),
      record_(&record),
      command_(first),
      period_s_(1.0 / performer.rate_hz),
      longest_s_(longest_s) {
  view_.X_PN_device = first.X_PN;
  record.note(first);
}

void LiveOperator::begin(double clock_offset_s, bool is_placed_anew) noexcept {
  offset_s_ = clock_offset_s;
  has_new_servers_ = true;
  is_placed_anew_ = is_placed_anew;
  if (is_placed_anew) record_->forget_scenes();
}

Status LiveOperator::note_interruption(double step_s, bool is_seen) {
  const bool was_away = has_new_servers_ && step_s > period_s_;
  const bool can_act = is_seen && !was_away && step_s <= kLongestGap_s;
  if (!can_act && !idle_) {
    const char* const reason = !is_seen ? tasks::kProgramDidNotRun : tasks::kSamplesWereLost;
    idle_ = tasks::Interruption{std::min(time_s_, time_s_ - step_s + period_s_), 0.0, reason};
  }
  if (idle_ && was_away) idle_->reason = is_placed_anew_ ? tasks::kServerWasAway : tasks::kServerSentNothing;
  if (!idle_ || !is_seen) return {};
  idle_->to_s = time_s_;
  const tasks::Interruption ended = *std::exchange(idle_, std::nullopt);
  interrupted_s_ += ended.to_s - ended.from_s;
  return record_->append(ended);
}

Result<double> LiveOperator::record(const telemetry::TickSample& tick, bool is_seen) {
  server_time_s_ = tick.time_s;
  if (!has_begun_) origin_s_ = tick.time_s - offset_s_;
  view_.last = tick;
  if (has_begun_ && has_new_servers_ && is_placed_anew_) note_resumption(view_.last);
  double step_s = has_begun_ ? std::max(0.0, tick.time_s - offset_s_ - origin_s_ - time_s_) : 0.0;
  time_s_ += step_s;
  if (has_begun_) TROCAR_TRY_STATUS(note_interruption(step_s, is_seen));
  has_begun_ = true;
  if (has_new_servers_) {
    paused_s_ += std::max(0.0, step_s - period_s_);
    step_s = period_s_;
  }
  has_new_servers_ = false;
  view_.last.time_s = time_s_;
  view_.X_PN_device = telemetry::device_pose(tick);
  TROCAR_TRY_STATUS(record_->append(view_.last));
  view_.returned = tasks::last_return(record_->actions());
  return step_s;
}

Result<bool> LiveOperator::take(const telemetry::TickSample& tick) {
  TROCAR_TRY(const double step_s, record(tick, true));
  // Ticks lost because this program did not read them count as unseen, too.
  view_.dt_s = std::min(step_s, kLongestHandStep_s);
  view_.time_s += view_.dt_s;
  unseen_s_ += step_s - view_.dt_s;
  command_ = performer_->the_operator->next(view_);
  if (command_.is_done || active_s() > longest_s_) return false;
  record_->note(command_);
  return true;
}

Status LiveOperator::take_unseen(const telemetry::TickSample& tick) {
  TROCAR_TRY(const double step_s, record(tick, false));
  unseen_s_ += step_s;
  return {};
}

Status LiveOperator::note_transducer(std::span<const link::NumberedSample> ticks, double clock_offset_s) {
  if (!has_begun_) return {};
  for (const link::NumberedSample& numbered : ticks) {
    const telemetry::TickSample& tick = numbered.sample;
    const double at_s = tick.time_s - clock_offset_s - origin_s_;
    if (at_s < 0.0) continue;
    TROCAR_TRY_STATUS(
        record_->append(storage::TransducerSample{at_s, telemetry::felt_probe(tick), tick.f_constraint_n.norm()}));
  }
  return {};
}

link::HandTarget LiveOperator::hand() const noexcept {
  return hand_target(command_, server_time_s_ + period_s_);
}

}  // namespace trocar::attempt
