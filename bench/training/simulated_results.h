#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/result.h"
#include "database/database_url.h"

namespace trocar::bench {

struct SimulatedResults {
  std::vector<std::string> people;    ///< Ids.
  std::vector<std::string> attempts;  ///< Ids of the last attempts, with traces.
  std::vector<std::string> tasks;
};

/// Fills a new database with the attempts of 200 simulated people (10 experts) at five tasks: scores that rise to a
/// limit, a value for every metric of the catalogue, all parts of the score; the last attempt of each person has a
/// trace of 60 s. All numbers are assumed, and all people are marked as simulated.
Result<SimulatedResults> fill_with_simulated_results(const database::DatabaseUrl& url, std::size_t attempts);

}  // namespace trocar::bench
