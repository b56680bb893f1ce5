#pragma once

#include <soci/soci.h>

#include <string>
#include <vector>

#include "results/attempts.h"

namespace trocar::results::detail {

inline constexpr const char* kCannotReadAttempts = "the attempts cannot be read";

/// A condition on rows of `attempts` ("a") with its parameters, texts before numbers.
struct AttemptQuery {
  std::string condition;  ///< " WHERE …", without order.
  std::vector<std::string> texts;
  std::vector<long long> numbers;

  void bind(soci::statement& statement) const;  ///< The query outlives the statement.
};

/// All of a filter but its order and limit.
AttemptQuery make_query(const AttemptFilter& filter);

/// `order`: " ORDER BY …". Throws soci::soci_error.
std::vector<Attempt> read_attempts(soci::session& session, const AttemptQuery& query, const std::string& order = {});

}  // namespace trocar::results::detail
