#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "results/attempts.h"

namespace trocar::results {

/// One row an attempt: person, group, course, case, times, score, a column each part and metric. Texts that a
/// spreadsheet would take for a formula (= + - @, tab) begin with an apostrophe, which reading removes. RFC 4180.
Result<std::string> attempts_csv(Repository& repository, const AttemptFilter& filter);
Status export_attempts(Repository& repository, const AttemptFilter& filter, const std::filesystem::path& file);

/// Names of the columns before those of parts and metrics.
inline constexpr std::array<std::string_view, 19> kAttemptColumns{
    "attempt", "person",   "group",   "simulated",   "course", "task",  "patient", "seed",       "hash",   "case",
    "level",   "operator", "station", "started_utc", "state",  "score", "passed",  "duration_s", "version"};
/// How the names of the columns of parts and of metrics begin; the most points of a part have a column "part NAME of".
inline constexpr std::string_view kPartColumn = "part ", kMetricColumn = "metric ", kOfMost = " of";

struct ImportedRows {
  std::int64_t added = 0, present = 0, people = 0;
  learning::AttemptCounts counts;  ///< Of the added ones.
};
/// Reads such a file into the database, all rows or none; people that do not exist are added. Attempts of every state
/// are kept. One that exists stays, with its path and recording; where the file knows its end and the database does
/// not, it is completed.
/// Errors name line and column: an unknown, missing or repeated column, another number of fields than in the header, a
/// field that is no number, time, state, level or truth value, a number out of its range, an attempt that occurs twice.
Result<ImportedRows> import_attempts(Repository& repository, const std::filesystem::path& file, Seconds now);

}  // namespace trocar::results
