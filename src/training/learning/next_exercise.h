#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "learning/curriculum.h"
#include "learning/past_attempt.h"

namespace trocar::learning {

enum class Purpose : std::uint8_t {
  kRepetition,  ///< A mastered exercise is due.
  kMoreHelp,    ///< The next step with one level more help, for the weakest part of the score.
  kNextStep,    ///< The first exercise that is not mastered.
  kNothing,     ///< Everything is mastered and nothing is due, or there is no case.
};
const char* to_string(Purpose purpose) noexcept;

/// What to practise next.
struct Recommendation {
  Purpose purpose = Purpose::kNothing;
  std::optional<Exercise> exercise;  ///< Empty only with kNothing.
  std::vector<std::string> reasons;  ///< Plain sentences, the most important first; at least one.
  std::vector<std::string> notes;    ///< Doubts about the history: attempts dated after `now`.
};

/// Decides by mastery, spaced repetition and the weakest part of the score, in this order: the repetition that is due
/// for the longest time; of the task in which the weakest part counts (else of the task practised last, else of the
/// first) the first exercise that is not mastered, with one level more help if that part is weak. Attempts without a
/// score or a level, and of unknown tasks, do not count. Attempts dated after `now` count as of now: a clock that was
/// set back postpones repetitions by less than one interval. `history` by time. `task`: only exercises of this task;
/// empty: all.
Recommendation next_exercise(std::span<const PastAttempt> history, const Curriculum& curriculum,
                             std::chrono::sys_seconds now, std::string_view task = {});

}  // namespace trocar::learning
