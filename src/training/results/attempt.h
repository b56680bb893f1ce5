#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "learning/history.h"
#include "results/people.h"
#include "results/repository.h"

namespace trocar::results {

/// The numbers are those of the database.
enum class State : std::uint8_t {
  kRunning,      ///< Begun on a station, its end is not known yet.
  kFinished,     ///< With a score.
  kInterrupted,  ///< The program ended before the attempt did; what it recorded is there.
  kUnscored,     ///< Ended without a score although the needle was in the body: counts as not passed.
  kNeverBegan,   ///< Ended without the needle in the body: does not count.
};
const char* to_string(State state) noexcept;  ///< "running", "finished", "interrupted", "unscored", "never-began".
std::optional<State> find_state(std::string_view name) noexcept;
/// Whether it counts, and why not.
learning::Ending ending_of(State state) noexcept;
State state_of(learning::Ending ending) noexcept;
/// True for the states that are final: a finished attempt is never written again.
constexpr bool has_ended(State state) noexcept {
  return state != State::kRunning && state != State::kInterrupted;
}

/// What is practised on.
struct Case {
  std::string task;                    ///< "liver-biopsy".
  std::string patient;                 ///< Embedded patient, or a folder's name.
  std::uint64_t seed = 1;              ///< Seed of an embedded patient.
  std::string patient_hash;            ///< Content of the patient.
  std::optional<int> difficulty = {};  ///< 1..5 of an embedded case.
};

/// An attempt without its details.
struct Attempt {
  std::string id;             ///< make_id(), the same in the session file.
  std::int64_t sequence = 0;  ///< Order of recording, from 1: curves follow it, not the clock.
  std::string person_id;
  Case the_case;
  std::string level;  ///< "guided", "assisted", "exam"; empty: not in the trainer's window.
  std::string operator_name;
  std::string station;  ///< Name of the computer.
  Seconds started{};
  State state = State::kRunning;
  std::optional<double> score;  ///< 0..100; empty unless its state is kFinished.
  bool is_passed = false;
  double duration_s = 0.0;  ///< Of the recording.
  std::string program_version;
};

struct Part {
  std::string name;  ///< One of tasks::kScoreParts.
  double points = 0.0;
  double max_points = 0.0;
  std::string value = {};  ///< For people: "3.1 mm"; empty: not known.
};
struct Measure {
  std::string name;  ///< Of the catalogue of metrics.
  std::string unit;
  double value = 0.0;  ///< Finite.
};

/// Path and forces at a low rate, for pictures. Frame P (LPS, mm). All vectors have the same length.
struct Trace {
  double rate_hz = 25.0;
  std::vector<double> time_s;
  std::array<std::vector<double>, 3> tip_mm;
  std::vector<double> depth_mm;
  std::vector<double> force_n;  ///< Along the axis; negative pushes the needle out.
  std::vector<int> tissue;      ///< Index of `tissues`.
  std::vector<std::string> tissues;
  std::array<double, 3> plan_entry_mm{}, plan_target_mm{};
  struct Event {
    double time_s = 0.0;
    std::string text;
  };
  std::vector<Event> events;
};

struct Hint {
  std::string text;
  std::optional<double> at_s;
};
/// All of an attempt except its recording.
struct AttemptRecord {
  Attempt attempt;  ///< `sequence` is given by the database.
  std::string not_scored;
  std::vector<std::string> fails;
  std::vector<Hint> hints;
  std::vector<Part> parts;
  std::vector<Measure> measures;
  Trace trace;
};

/// For the learning path.
learning::PastAttempt past_attempt_of(const Attempt& attempt, const std::vector<Part>& parts);

/// Why an attempt did not pass; all empty: it passed, or nothing is known.
struct Reasons {
  std::string not_scored;          ///< Why it has no score.
  std::vector<std::string> fails;  ///< As in AttemptRecord.
};

/// Of attempts of a person with a sequence of `first` to `last` that were not passed, by sequence. For lists: it reads
/// neither paths nor measures.
Result<std::map<std::int64_t, Reasons>> list_reasons(Repository& repository, std::string_view person_id,
                                                     std::int64_t first, std::int64_t last);

}  // namespace trocar::results
