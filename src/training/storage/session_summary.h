#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "storage/session_file.h"

namespace trocar::storage {

/// A session without its recording.
struct SessionSummary {
  SessionInfo info;                         ///< The tissue table is that of the start, without names of ids.
  std::optional<scoring::Outcome> outcome;  ///< Missing in an incomplete session.
  bool is_incomplete() const noexcept { return !outcome.has_value(); }
};

/// Reads info and outcome of a session and checks their checksums; the time does not grow with the recording. Errors:
/// those of load_session, but for damage in the recording, which passes unnoticed.
Result<SessionSummary> load_summary(const std::filesystem::path& path);

}  // namespace trocar::storage
