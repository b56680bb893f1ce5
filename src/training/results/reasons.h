#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "results/repository.h"

namespace trocar::results {

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
