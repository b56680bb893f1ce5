#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "learning/curriculum.h"
#include "learning/history.h"

namespace trocar::learning {

enum class Purpose : std::uint8_t {
  kRepetition,     ///< A mastered exercise is due.
  kMoreHelp,       ///< The next step with one level more help, for the part of the score that costs the most points.
  kNextStep,       ///< The first exercise that is not mastered.
  kTestOut,        ///< The next case at the exam at once: a pass skips its steps with help.
  kInterleave,     ///< Another exercise in between, after so many attempts at one in a row.
  kSeeInstructor,  ///< No progress at an exercise; `exercise` is another one to go on with.
  kNothing,        ///< Everything is mastered and nothing is due, or there is no case.
};
const char* to_string(Purpose purpose) noexcept;

/// What to practise next.
struct Recommendation {
  Purpose purpose = Purpose::kNothing;
  std::optional<Exercise> exercise;  ///< Empty with kNothing, and if there is no other one with kSeeInstructor.
  std::vector<std::string> reasons;  ///< Plain sentences, the most important first; at least one.
  std::vector<std::string> notes;    ///< Findings about the history: attempts dated after `now`.
};

/// Decides by mastery, spaced repetition and the part of the score that costs the most points, in this order:
/// - "see your instructor" if the exercise that would come next has a plateau, with the next fitting one to go on with;
/// - the repetition that is due for the longest time;
/// - of the task in which the weakest part counts (else of the task practised last, else of the first) the first
///   exercise that is not mastered. At a new case the exam, if the case before it was mastered at the exam without a
///   failure; with one level more help, for some attempts after a failure, if that part is weak;
/// - another exercise (of another task, else of another case, else at another level), if this one was practised
///   rules.most_in_a_row times in a row. The same holds for repetitions.
/// Attempts that do not count (PastAttempt::is_practice), and of unknown tasks, are left out. Attempts dated after
/// `now` count as of now: a clock that was set back postpones repetitions by less than one interval. `history` by time.
/// `task`: only exercises of this task; empty: all.
Recommendation next_exercise(std::span<const PastAttempt> history, const Curriculum& curriculum,
                             std::chrono::sys_seconds now, std::string_view task = {});

}  // namespace trocar::learning
