#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "storage/session_file.h"

namespace trocar::learning {

/// Level of help of an attempt, from most to least.
enum class TrainingMode : std::uint8_t { kGuided, kAssisted, kExam };
inline constexpr std::array kTrainingModes{TrainingMode::kGuided, TrainingMode::kAssisted, TrainingMode::kExam};
/// Name in a session file: "assisted".
const char* to_string(TrainingMode level) noexcept;
std::optional<TrainingMode> find_training_mode(std::string_view name) noexcept;

/// How an attempt ended, which decides whether it counts.
enum class Ending : std::uint8_t {
  kScored,      ///< With a score, passed or not.
  kUnscored,    ///< Without a score although the needle was in the body: counts as not passed.
  kNeverBegan,  ///< The needle was never in the body: does not count.
  kLost,        ///< The program ended before the attempt did (crash, power), or its result is damaged: does not count.
  kRunning,     ///< It has not ended yet.
};
/// True if an attempt of this ending counts as one: passed or not passed.
constexpr bool counts(Ending ending) noexcept {
  return ending == Ending::kScored || ending == Ending::kUnscored;
}

/// Which attempts count, and why the others do not.
struct AttemptCounts {
  std::int64_t scored = 0, passed = 0;  ///< `passed` of `scored`.
  std::int64_t unscored = 0, never_began = 0, lost = 0, running = 0;
  std::int64_t without_level = 0;  ///< For the learning path: not at a level of help.

  std::int64_t counted() const noexcept { return scored + unscored; }
  std::int64_t left_out() const noexcept { return never_began + lost + running + without_level; }
  void add(Ending ending, bool is_passed, std::int64_t count = 1) noexcept;
  void add(const AttemptCounts& other) noexcept;
};
/// "24 attempts counted (16 ended without a result), 3 left out: 2 never began, 1 was lost to a crash".
std::string counts_text(const AttemptCounts& counts);

/// What the learning path knows of one attempt, whatever stores it.
struct PastAttempt {
  std::string task;     ///< "liver-biopsy".
  std::string patient;  ///< Name of an embedded patient, or a folder.
  std::uint64_t patient_seed = 1;
  std::optional<TrainingMode> level;  ///< Empty: not in the trainer's window, or an older program.
  std::chrono::sys_seconds when{};    ///< Begin, UTC.
  std::optional<double> score = {};   ///< 0..100; empty unless its ending is kScored.
  bool is_passed = false;
  /// Points of each judged part of the score over its most points, 0..1, by the names of tasks::kScoreParts.
  std::map<std::string, double, std::less<>> part_shares = {};
  Ending ending = Ending::kScored;

  /// True if it counts in the learning path: it ended in the body, at a level of help.
  bool is_practice() const noexcept { return counts(ending) && level.has_value(); }
};

/// The attempts of a folder of session files.
struct History {
  std::vector<PastAttempt> attempts;  ///< By time; of the same second: by file name.
  std::vector<std::string> damaged;   ///< One line for each session that cannot be read.
};

/// "2026-01-02T03:04:05Z", as sessions have it; empty: another form, or no such time.
std::optional<std::chrono::sys_seconds> parse_utc(std::string_view text);

/// The metric that tells whether the needle was in the body: punctures of the skin.
inline constexpr std::string_view kInBodyMetric = "skin_punctures";
/// Whether the needle was in the body, by the punctures of the skin; in a session of an older program by the reason why
/// it was not scored.
bool was_in_body(const scoring::Outcome& outcome);
Ending ending_of(const storage::SessionSummary& session);
/// Error: the time of the session is none.
Result<PastAttempt> attempt_of(const storage::SessionSummary& session);

/// The session files (*.trocar, *.session) of a folder, by name. A folder that does not exist has none. Error: it
/// cannot be read.
Result<std::vector<std::filesystem::path>> find_sessions(const std::filesystem::path& folder);

/// Reads info and outcome of all sessions of a folder, on several threads. Errors: those of find_sessions. Empty if
/// `stop` was requested.
Result<History> read_history(const std::filesystem::path& folder, const std::stop_token& stop = {});

}  // namespace trocar::learning
