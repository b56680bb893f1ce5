#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/offline/run_session.h"
#include "tasks/operator.h"

namespace trocar::attempt {

inline constexpr double kLongestAttempt_s = 120.0;  ///< Limit after which an operator is stopped.

/// An operator and its options.
struct Performer {
  std::unique_ptr<tasks::Operator> the_operator;
  double rate_hz = 1000.0;
  bool has_own_rate = false;  ///< It was recorded at that rate and can be run at no other.
  std::string force_model;    ///< The user's, else the task's or that of the replayed session.
  /// Of a replay: the session, and the parameters by tick with what the user changes of them.
  std::shared_ptr<const storage::Session> replayed = nullptr;
  std::vector<storage::SessionParameters> parameters = {};
};

/// Whether there is an operator of that name (exit status 2 where not).
Status check_operator(std::string_view name);
/// The session of a replay:SESSION; null for another operator. Errors: the file, a session without ticks.
Result<std::shared_ptr<const storage::Session>> load_replayed(std::string_view operator_name);
/// Errors: no such operator, a session to be replayed that cannot be read or is of another patient.
Result<Performer> make_performer(const cases::Case& the_case, const RunOptions& options);
/// The preset of the device on which a session was recorded; empty: it was none of data/devices.toml.
std::string recorded_preset(const storage::SessionInfo& info);
/// The options with what a replay takes of its session: seeds, rate, device.
RunOptions options_of(const Performer& performer, RunOptions options);

}  // namespace trocar::attempt
