#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "results/attempts.h"

namespace trocar::results {

/// One row an attempt: person, group, course, case, times, score, a column each part and metric. Texts that a
/// spreadsheet would take for a formula (= + - @, tab) begin with an apostrophe, which reading removes. RFC 4180.
Result<std::string> attempts_csv(Repository& repository, const AttemptFilter& filter);
Status export_attempts(Repository& repository, const AttemptFilter& filter, const std::filesystem::path& file);

/// How the names of the columns of parts and of metrics begin.
inline constexpr std::string_view kPartColumn = "part ", kMetricColumn = "metric ";

struct ImportedRows {
  std::int64_t added = 0, present = 0, people = 0;
  learning::AttemptCounts counts;  ///< Of the added ones.
};
/// Reads such a file into the database, all rows or none; people that do not exist are added. Attempts of every state
/// are kept. One that exists stays, with its path and recording; where the file knows its end and the database does
/// not, it is completed.
/// Errors name row and column.
Result<ImportedRows> import_attempts(Repository& repository, const std::filesystem::path& file, Seconds now);

}  // namespace trocar::results
