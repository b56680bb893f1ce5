#pragma once

#include <string>

#include "attempt/offline/run_session.h"
#include "core/result.h"
#include "results/repository.h"

namespace trocar::cli {

/// Opens the database of --db for the attempts of a person, and names person and attempt in the run's options. Error
/// (exit status 2): there is no such person.
Result<results::Repository> open_for_person(const std::string& person, const std::string& url,
                                            attempt::RunOptions& run);
/// Writes that an attempt in real time has begun: if this program is killed, its session file completes it later
/// (trocar results import).
Status record_begin(results::Repository& repository, const cases::Case& the_case, const attempt::RunOptions& run);
/// Records the finished session.
Status record_end(results::Repository& repository, const attempt::RunOptions& run);

}  // namespace trocar::cli
