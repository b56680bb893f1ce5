#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "headless/run_session.h"
#include "training/operator.h"

namespace trocar {

inline constexpr double kLongestAttempt_s = 120.0;  ///< An operator that is not done by then is stopped.

/// An operator and how it wants to be run.
struct Performer {
  std::unique_ptr<Operator> the_operator;
  double rate_hz = 1000.0;
  bool has_own_rate = false;  ///< It was recorded at that rate and can be run at no other.
  std::string force_model;    ///< The user's, else the task's or that of the replayed session.
};

/// Whether there is an operator of that name (exit status 2 where not).
Status check_operator(std::string_view name);
/// Errors: no such operator, a session to be replayed that cannot be read.
Result<Performer> make_performer(const Case& the_case, const RunOptions& options);

}  // namespace trocar
