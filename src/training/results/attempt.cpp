#include "results/attempt.h"

#include <algorithm>
#include <cmath>

#include "results/detail/attempt_query.h"
#include "results/detail/details_json.h"

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

Result<std::map<std::int64_t, Reasons>> list_reasons(Repository& repository, std::string_view person_id,
                                                     std::int64_t first, std::int64_t last) {
  using Found = std::map<std::int64_t, Reasons>;
  return repository.database().run("the attempts cannot be read", [&](soci::session& session) {
    Found found;
    const std::string person(person_id);
    const long long low = first, high = last;
    long long sequence = 0;
    std::string verdict;
    AttemptRecord record;
    soci::statement select =
        (session.prepare << "SELECT a.sequence, a.id, d.verdict FROM attempts a JOIN attempt_details d"
                            " ON d.sequence = a.sequence WHERE a.person_id = :p AND a.is_passed = 0"
                            " AND a.sequence >= :l AND a.sequence <= :h",
         soci::use(person), soci::use(low), soci::use(high), soci::into(sequence), soci::into(record.attempt.id),
         soci::into(verdict));
    select.execute();
    while (select.fetch()) {
      record.not_scored.clear();
      record.fails.clear();
      record.hints.clear();
      // One damaged attempt must not hide the others.
      if (const Status read = detail::read_verdict(verdict, record); !read)
        record.fails = {read.error().what + ": " + read.error().advice};
      found[sequence] = {record.not_scored, record.fails};
    }
    return found;
  });
}

}  // namespace trocar::results
