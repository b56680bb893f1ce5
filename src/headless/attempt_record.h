#pragma once

#include <optional>
#include <string>
#include <vector>

#include "headless/run_session.h"
#include "training/operator.h"

namespace trocar {

/// What an attempt's record says of how it was made, beside case and options.
struct AttemptFacts {
  std::string device;  ///< In words.
  double rate_hz = 1000.0;
  std::string force_model;
};

/// The transducer is recorded so often at most: a hand moves it 0.6 mm in that time, its tremor has 8 to 12 Hz, a
/// screen shows 60 pictures a second. It makes a file about 5 % larger; every tick would make it half as large again.
inline constexpr double kTransducerEvery_s = 0.01;

/// An attempt while it happens: every tick in memory and in the session file, scored at the end. What was appended is
/// in the file, whatever becomes of the attempt.
class AttemptRecord {
 public:
  /// The case must outlive it. Errors: the session file.
  static Result<AttemptRecord> create(const Case& the_case, const RunOptions& options, const AttemptFacts& facts);

  /// What the operator does before the next tick: fires, perhaps.
  void note(const HandCommand& command) noexcept;
  Status append(const TickSample& sample);
  /// Kept at most every kTransducerEvery_s; it has no part in the score.
  Status append(const TransducerSample& sample);
  const SessionInfo& info() const noexcept { return info_; }
  const std::vector<TickSample>& samples() const noexcept { return samples_; }  ///< So far.
  /// Scores, and closes the session file.
  Result<RunResult> finish();

 private:
  AttemptRecord(const Case& the_case, SessionInfo info, SessionWriter writer, std::size_t expected_ticks);

  const Case* the_case_;
  SessionInfo info_;
  SessionWriter writer_;
  std::vector<TickSample> samples_;
  std::optional<std::size_t> fired_;
  std::optional<double> transducer_s_;  ///< Of the last one kept.
};

}  // namespace trocar
