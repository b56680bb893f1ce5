#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace trocar {
inline namespace core {

/// A value with undo and redo steps. Each step stores a whole value: large parts of values should be shared.
template <class State>
class StepHistory {
 public:
  static constexpr std::size_t kMostSteps = 200;
  explicit StepHistory(std::size_t most_steps = kMostSteps) : most_steps_(most_steps) {}

  const State& now() const noexcept { return now_; }

  /// Sets another value and clears all steps.
  void begin(State state) {
    now_ = std::move(state);
    before_.clear();
    after_.clear();
  }
  /// Adds a step to another value. `joins`: merge it with the last step (a slider that is still dragged). Clears redo;
  /// beyond the limit the oldest step is dropped.
  void step_to(State next, bool joins = false) {
    if (!joins || before_.empty()) before_.push_back(std::move(now_));
    if (before_.size() > most_steps_) before_.pop_front();
    after_.clear();
    now_ = std::move(next);
  }
  /// Replaces the present value without a step.
  void put(State state) { now_ = std::move(state); }
  /// Changes the present value and all values of the undo and redo steps.
  template <class Change>
  void change_all(const Change& change) {
    change(now_);
    for (State& state : before_) change(state);
    for (State& state : after_) change(state);
  }

  bool can_undo() const noexcept { return !before_.empty(); }
  bool can_redo() const noexcept { return !after_.empty(); }
  /// The value after redo(). Requires can_redo().
  const State& next() const noexcept { return after_.back(); }
  void undo() {  ///< No effect if can_undo() is false.
    if (!can_undo()) return;
    after_.push_back(std::exchange(now_, std::move(before_.back())));
    before_.pop_back();
  }
  void redo() {
    if (!can_redo()) return;
    before_.push_back(std::exchange(now_, std::move(after_.back())));
    after_.pop_back();
  }

 private:
  std::size_t most_steps_;
  State now_{};
  std::deque<State> before_;
  std::vector<State> after_;
};

}  // namespace core
}  // namespace trocar
