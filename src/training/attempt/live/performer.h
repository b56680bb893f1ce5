#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/offline/run_session.h"
#include "tasks/operator.h"

namespace trocar::attempt {

inline constexpr double kLongestHandStep_s = 0.02;  ///< A longer gap between ticks is a pause, not a motion of a hand.
inline constexpr double kLongestAttempt_s = 120.0;  ///< Limit after which an operator is stopped.

/// An operator and its options.
struct Performer {
  std::unique_ptr<tasks::Operator> the_operator;
  double rate_hz = 1000.0;
  bool has_own_rate = false;  ///< The operator was recorded at this rate and cannot run at another one.
  std::string force_model;    ///< Force model of the user, otherwise of the task or of the replayed session.
  /// Replay only: the session, and its parameters by tick with the user's changes.
  std::shared_ptr<const storage::Session> replayed = nullptr;
  std::vector<storage::SessionParameters> parameters = {};
};

/// Checks that an operator of that name exists (exit status 2 if not).
Status check_operator(std::string_view name);
/// Loads the session of a replay:SESSION; null for another operator. Errors: file errors, a session without ticks.
Result<std::shared_ptr<const storage::Session>> load_replayed(std::string_view operator_name);
/// Errors: an unknown operator, a replayed session that cannot be read or belongs to another patient.
Result<Performer> make_performer(const cases::Case& the_case, const RunOptions& options);
/// Preset of the device on which a session was recorded; empty: the device is not in data/devices.toml.
std::string recorded_preset(const storage::SessionInfo& info);
/// Returns the options; a replay replaces seeds, rate and device by those of its session.
RunOptions options_of(const Performer& performer, RunOptions options);

}  // namespace trocar::attempt
