#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "attempt/live/performer.h"
#include "attempt/record/attempt_record.h"
#include "attempt/tools/tool_motion.h"
#include "link/client/haptic_client.h"
#include "tasks/operator.h"

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

/// Converts a command to a target for a server's hand: the in-process hand (tasks/operator.h), which holds the tip.
/// `server_time_s`: server time for which the target is meant.
link::HandTarget hand_target(const tasks::HandCommand& command, double server_time_s) noexcept;

/// The operator of every live attempt: the trainee's hand, led by the window, or a scripted operator. A scripted
/// operator of the attempt's options begins at its first pose; one that is given later begins after the hand has moved
/// to its first pose, and the trainee continues after it.
class NeedleSteering final : public tasks::Operator {
 public:
  LedPose& hand() noexcept { return hand_; }
  const LedPose& hand() const noexcept { return hand_; }
  bool is_performing() const noexcept { return performer_ != nullptr; }
  /// The performer is that of the attempt's options: the attempt begins with its first command.
  bool is_scripted() const noexcept { return is_scripted_; }

  /// Places the hand at the performer's first command and returns that command. `dt_s`: period of the ticks.
  /// `ends_with_it`: the attempt ends with the performer.
  tasks::HandCommand begin_with(std::unique_ptr<tasks::Operator> performer, double dt_s, bool ends_with_it) {
    performer_ = std::move(performer);
    is_scripted_ = is_at_start_ = true;
    ends_with_performer_ = ends_with_it;
    tasks::OperatorView before;
    before.dt_s = dt_s;
    first_ = performer_->next(before);
    hand_.put(first_.X_PN);
    return first_;
  }

  /// The hand moves to the performer's first pose; then the performer moves it. Null: the trainee moves the hand.
  void perform(std::unique_ptr<tasks::Operator> performer) noexcept {
    performer_ = std::move(performer);
    is_scripted_ = is_at_start_ = false;
    performed_s_ = 0.0;
    if (performer_ == nullptr) return;
    first_ = performer_->next({});
    hand_.clamp(false);
    hand_.lead(first_.X_PN, Vec3::Zero(), Vec3::Zero());
  }

  /// Call after the server has placed the needle at this pose.
  void resume_at(const Pose& X_PN) noexcept {
    if (is_performing()) return;  // its hand goes on by itself
    const Pose goal = hand_.goal_P();
    hand_.put(X_PN);
    hand_.lead(goal, Vec3::Zero(), Vec3::Zero());
  }

  tasks::HandCommand next(const tasks::OperatorView& view) noexcept override {
    tasks::HandCommand command = is_performing() ? next_of_performer(view) : tasks::HandCommand{};
    if (!is_performing() && !command.is_done) {
      hand_.step(view.dt_s);
      command = led();
    }
    return command;
  }

 private:
  tasks::HandCommand led() const noexcept {
    tasks::HandCommand command;
    command.X_PN = hand_.X_P();
    command.v_P = hand_.v_P();
    return command;
  }

  tasks::HandCommand next_of_performer(const tasks::OperatorView& view) noexcept {
    constexpr double kThere_mm = 0.5, kThere_rad = 0.02;
    if (!is_at_start_) {
      hand_.step(view.dt_s);
      is_at_start_ = (hand_.X_P().p() - first_.X_PN.p()).norm() < kThere_mm &&
                     turn_between(hand_.X_P().R(), first_.X_PN.R()).norm() < kThere_rad;
      return led();
    }
    tasks::OperatorView own = view;
    own.time_s = performed_s_ += view.dt_s;
    tasks::HandCommand command = performer_->next(own);
    hand_.put(command.X_PN);
    if (command.is_done) performer_.reset();
    command.is_done = command.is_done && ends_with_performer_;
    return command;
  }

  LedPose hand_;
  std::unique_ptr<tasks::Operator> performer_;
  tasks::HandCommand first_;
  double performed_s_ = 0.0;
  bool is_scripted_ = false, ends_with_performer_ = false;
  bool is_at_start_ = false;
};

}  // namespace trocar::attempt
