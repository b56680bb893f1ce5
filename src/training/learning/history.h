#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "learning/past_attempt.h"
#include "storage/session_summary.h"

namespace trocar::learning {

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
