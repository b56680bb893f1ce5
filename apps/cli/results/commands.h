#pragma once

#include <memory>
#include <string>

#include "cli/action.h"
#include "cli/output.h"
#include "results/repository.h"

namespace trocar::cli {

/// Text of the option --db of `results`, filled while the command line is parsed.
using DatabaseOption = std::shared_ptr<const std::string>;

// Sub-commands of `results`.
void add_results_people_commands(Command& results, const DatabaseOption& url, Action& action);
void add_results_attempt_commands(Command& results, const DatabaseOption& url, Action& action);
void add_results_exchange_commands(Command& results, const DatabaseOption& url, Action& action);
void add_results_curve_command(Command& results, const DatabaseOption& url, Action& action);
void add_results_proficiency_command(Command& results, const DatabaseOption& url, Action& action);
void add_results_validity_command(Command& results, const DatabaseOption& url, Action& action);

/// Opens the database of --db; empty: $TROCAR_DB, else that of the user. `missing`: whether a new one is made.
Result<results::Repository> open_results(const std::string& url, database::Missing missing);
/// Prints how the database is kept where it has no write-ahead log.
void warn_of_journal(results::Repository& repository);

/// Warns after a deletion if another program has kept the deleted data in the write-ahead log.
void warn_of_log(results::Repository& repository);

/// "2026-01-02 03:04" in UTC.
std::string minute_text(results::Seconds time);
results::Seconds now_s();

}  // namespace trocar::cli
