#pragma once

#include <memory>
#include <utility>

#include "attempt/tools/led_pose.h"
#include "tasks/operator.h"

namespace trocar::attempt {

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
