#pragma once

#include <memory>
#include <utility>

#include "attempt/hands/hand_motion.h"
#include "tasks/operator.h"

namespace trocar::attempt {

inline constexpr HandLimits kSteeredHand;  ///< A jump of the mouse is no jump of the tool.

/// Who moves the needle's hand: the trainee's, led by the window, or a scripted operator, to whose start the hand goes
/// first. To the attempt it is one operator that is never done.
class SteeredNeedle final : public tasks::Operator {
 public:
  LedHand& hand() noexcept { return hand_; }
  void fire() noexcept { fires_ = true; }
  bool has_fired() const noexcept { return has_fired_; }
  bool is_performing() const noexcept { return performer_ != nullptr; }

  void perform(std::unique_ptr<tasks::Operator> performer) noexcept {
    performer_ = std::move(performer);
    is_at_start_ = false;
    performed_s_ = 0.0;
    if (performer_ == nullptr) return;
    first_ = performer_->next({});
    hand_.clamp(false);
    hand_.lead(first_.X_PN, Vec3::Zero(), Vec3::Zero());
  }

  /// The server put the needle there.
  void resume_at(const Pose& X_PN) noexcept {
    if (is_performing()) return;  // its hand goes on by itself
    const Pose goal = hand_.goal_P();
    hand_.put(X_PN);
    hand_.lead(goal, Vec3::Zero(), Vec3::Zero());
  }

  tasks::HandCommand next(const tasks::OperatorView& view) noexcept override {
    tasks::HandCommand command = is_performing() ? next_of_performer(view) : tasks::HandCommand{};
    if (!is_performing()) {
      hand_.step(view.dt_s);
      command = tasks::HandCommand{};
      command.X_PN = hand_.X_P();
      command.v_P = hand_.v_P();
    }
    command.has_fired = (command.has_fired || fires_) && !has_fired_;
    has_fired_ = has_fired_ || command.has_fired;
    fires_ = false;
    return command;
  }

 private:
  tasks::HandCommand next_of_performer(const tasks::OperatorView& view) noexcept {
    constexpr double kThere_mm = 0.5, kThere_rad = 0.02;
    if (!is_at_start_) {
      hand_.step(view.dt_s);
      tasks::HandCommand going;
      going.X_PN = hand_.X_P();
      going.v_P = hand_.v_P();
      is_at_start_ = (hand_.X_P().p() - first_.X_PN.p()).norm() < kThere_mm &&
                     turn_between(hand_.X_P().R(), first_.X_PN.R()).norm() < kThere_rad;
      return going;
    }
    tasks::OperatorView own = view;
    own.time_s = performed_s_ += view.dt_s;
    tasks::HandCommand command = performer_->next(own);
    hand_.put(command.X_PN);
    if (command.is_done) performer_.reset();
    command.is_done = false;
    return command;
  }

  LedHand hand_{kSteeredHand};
  std::unique_ptr<tasks::Operator> performer_;
  tasks::HandCommand first_;
  double performed_s_ = 0.0;
  bool is_at_start_ = false;
  bool fires_ = false, has_fired_ = false;
};

}  // namespace trocar::attempt
