#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "results/attempts.h"

namespace trocar::results {

/// Names of the columns before those of parts and metrics.
inline constexpr std::array<std::string_view, 19> kAttemptColumns{
    "attempt", "person",   "group",   "simulated",   "course", "task",  "patient", "seed",       "hash",   "case",
    "level",   "operator", "station", "started_utc", "state",  "score", "passed",  "duration_s", "version"};

/// Attempts as CSV, piece by piece: one row an attempt with person, group, course, case, times, score, a column each
/// part and metric. Texts are quoted, and guarded against spreadsheets (csv_text.h), which reading undoes. RFC 4180.
/// It has the attempts that were there at its begin; those that are deleted meanwhile are missing from then on.
class AttemptsExport {
 public:
  /// Order and limit of the filter are ignored.
  static Result<AttemptsExport> begin(Repository& repository, const AttemptFilter& filter);
  /// The next piece, first the row of the names; empty: the end. Each one is read at one state of the database. Error:
  /// also an attempt that has got a part or metric meanwhile for which there is no column.
  Result<std::string> next(Repository& repository);

 private:
  AttemptFilter filter_;
  std::string header_;
  std::map<std::string, Person> people_;
  /// Places of values behind the fixed columns.
  std::map<std::string, std::size_t, std::less<>> parts_;
  std::map<long long, std::size_t> metrics_;
  std::size_t values_ = 0;
  std::int64_t after_ = 0, last_ = 0;  ///< Sequences: of the last written attempt, of the last one at the begin.
};

/// The whole text, for few attempts.
Result<std::string> attempts_csv(Repository& repository, const AttemptFilter& filter);
Status export_attempts(Repository& repository, const AttemptFilter& filter, const std::filesystem::path& file);

struct ImportedRows {
  std::int64_t added = 0, present = 0, people = 0;
  learning::AttemptCounts counts;  ///< Of the added ones.
};
/// Reads such a file into the database, all rows or none; people that do not exist are added. Attempts of every state
/// are kept. One that exists stays, with its path and recording; where the file knows its end and the database does
/// not, it is completed. The file is read row by row.
/// Errors name line and column: an unknown, missing or repeated column, another number of fields than in the header, a
/// field that is no number, time, state, level or truth value, a number out of its range, an attempt that occurs twice,
/// a text that is not UTF-8 or has a NUL byte.
Result<ImportedRows> import_attempts(Repository& repository, const std::filesystem::path& file, Seconds now);

}  // namespace trocar::results
