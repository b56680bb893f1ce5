#pragma once

#include <optional>
#include <span>

#include "attempt/live/performer.h"
#include "attempt/record/attempt_record.h"
#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// Operator of an attempt with ticks from a live server, some milliseconds late: records every tick, passes it to the
/// operator, and sends the next hand target.
class LiveOperator {
 public:
  /// Performer and record must outlive it. `first`: the operator's first command, requested by the caller; it placed
  /// the hand. After `longest_s` of active time the attempt is done, even if the operator is not.
  LiveOperator(const Performer& performer, AttemptRecord& record, const tasks::HandCommand& first,
               double longest_s = kLongestAttempt_s);

  /// Call when ticks arrive for the first time, or again after a gap. `clock_offset_s`: the server's clock minus ours.
  /// `is_placed_anew`: the server reloaded the scene and its insertion restarted; otherwise only messages were missing.
  void begin(double clock_offset_s, bool is_placed_anew = true) noexcept;
  /// Takes a tick of the server and converts its time to session time. false: the operator is done.
  Result<bool> take(const telemetry::TickSample& tick);
  /// Records a tick that is too late for a reply because this program was not scheduled. The operator's time does not
  /// advance.
  Status take_unseen(const telemetry::TickSample& tick);
  /// Records ticks of the transducer's server in session time. `clock_offset_s`: that server's clock minus ours. No
  /// effect before the needle's first tick, which begins the session.
  Status note_transducer(std::span<const link::NumberedSample> ticks, double clock_offset_s);
  /// Target of the hand in reply to the last tick.
  link::HandTarget hand() const noexcept;

  double time_s() const noexcept { return time_s_; }  ///< Session time.
  /// Active time: without server outages, lost ticks and ticks too late for a reply.
  double active_s() const noexcept { return time_s_ - interrupted_s_; }
  double paused_s() const noexcept { return paused_s_; }  ///< Part of time_s() without a server.
  /// Part of time_s() whose ticks the operator did not process.
  double unseen_s() const noexcept { return unseen_s_; }
  const telemetry::TickSample& last() const noexcept { return view_.last; }  ///< Last tick, in session time.
  const tasks::HandCommand& command() const noexcept { return command_; }    ///< Command in reply to the last tick.

 private:
  /// Records a tick and returns the time since the last one. Unseen: the operator does not reply to it.
  Result<double> record(const telemetry::TickSample& tick, bool is_seen);
  /// Records an interruption that ends with the current tick.
  Status note_interruption(double step_s, bool is_seen);

  const Performer* performer_;
  AttemptRecord* record_;
  tasks::HandCommand command_;
  tasks::OperatorView view_;
  double period_s_;
  double longest_s_;
  double offset_s_ = 0.0;
  double origin_s_ = 0.0;
  double time_s_ = 0.0;
  double paused_s_ = 0.0;
  double unseen_s_ = 0.0;
  double interrupted_s_ = 0.0;
  std::optional<tasks::Interruption> idle_;  ///< The current interruption.
  double server_time_s_ = 0.0;
  bool has_begun_ = false;
  bool has_new_servers_ = false, is_placed_anew_ = false;
};

/// Converts a command to a target for a server's hand: the in-process hand (tasks/hand.h), which holds the tip.
/// `server_time_s`: server time for which the target is meant.
link::HandTarget hand_target(const tasks::HandCommand& command, double server_time_s) noexcept;

}  // namespace trocar::attempt
