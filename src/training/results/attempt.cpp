#include "results/attempt.h"

#include <algorithm>
#include <cmath>

namespace trocar::results {
namespace {
constexpr std::array kStates{State::kRunning, State::kFinished, State::kInterrupted, State::kUnscored,
                             State::kNeverBegan};
}

const char* to_string(State state) noexcept {
  constexpr std::array kNames{"running", "finished", "interrupted", "unscored", "never-began"};
  return kNames[static_cast<std::size_t>(state)];
}

std::optional<State> find_state(std::string_view name) noexcept {
  for (const State state : kStates)
    if (name == to_string(state)) return state;
  return std::nullopt;
}

learning::Ending ending_of(State state) noexcept {
  constexpr std::array kEndings{learning::Ending::kRunning, learning::Ending::kScored, learning::Ending::kLost,
                                learning::Ending::kUnscored, learning::Ending::kNeverBegan};
  return kEndings[static_cast<std::size_t>(state)];
}

State state_of(learning::Ending ending) noexcept {
  const auto found =
      std::find_if(kStates.begin(), kStates.end(), [&](State state) { return ending_of(state) == ending; });
  return found == kStates.end() ? State::kInterrupted : *found;
}

learning::PastAttempt past_attempt_of(const Attempt& attempt, const std::vector<Part>& parts) {
  learning::PastAttempt past{attempt.the_case.task, attempt.the_case.patient, attempt.the_case.seed,
                             learning::find_training_mode(attempt.level), attempt.started};
  past.ending = ending_of(attempt.state);
  if (past.ending != learning::Ending::kScored || !attempt.score) return past;
  past.score = std::clamp(*attempt.score, 0.0, 100.0);
  past.is_passed = attempt.is_passed;
  for (const Part& part : parts)
    if (part.max_points > 0.0) past.part_shares[part.name] = std::clamp(part.points / part.max_points, 0.0, 1.0);
  return past;
}

}  // namespace trocar::results
