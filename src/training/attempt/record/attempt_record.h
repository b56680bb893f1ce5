#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/offline/run_session.h"
#include "attempt/record/known_scenes.h"
#include "tasks/operator.h"

namespace trocar::attempt {

/// What an attempt's record says of how it was made, beside case and options.
struct AttemptFacts {
  std::string device;  ///< In words.
  double rate_hz = 1000.0;
  std::string force_model;
  std::string device_preset;   ///< Of data/devices.toml; empty: none of them.
  SceneParameters parameters;  ///< In force when it begins, as far as known; no table: the case's.
  std::string level = {};      ///< See SessionInfo.
};

/// The preset of a server's device: "premium" of "virtual:premium"; empty: it is none of data/devices.toml.
std::string preset_of_device(std::string_view device_name);

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
  void note(const tasks::HandCommand& command) noexcept;
  Status append(const telemetry::TickSample& sample);
  /// The last appended sample was made with these parameters. Recorded where they are others than before.
  Status note_parameters(const SceneParameters& parameters);
  /// The same of the scene of a server by its number. One that is not known yet is recorded later, by another call.
  Status note_scene(std::uint64_t number, const KnownScenes& known);
  /// Another server comes, with other numbers of scenes.
  void forget_scenes() noexcept;
  /// Before the first sample after it.
  Status append(const tasks::Interruption& interruption);
  const std::vector<tasks::Interruption>& interruptions() const noexcept { return interruptions_; }
  /// Kept at most every kTransducerEvery_s; it has no part in the score.
  Status append(const storage::TransducerSample& sample);
  const storage::SessionInfo& info() const noexcept { return info_; }
  const std::vector<telemetry::TickSample>& samples() const noexcept { return samples_; }  ///< So far.
  /// The sample at which the gun was fired; it may be still to come.
  const std::optional<std::size_t>& fired() const noexcept { return fired_; }
  /// Scores, and closes the session file.
  Result<RunResult> finish();
  /// The first failure to write the session file; empty: all is well.
  const std::optional<Error>& write_failure() const noexcept { return write_failure_; }
  /// After such a failure: scores what was recorded, and says how much of it the file lacks.
  RunResult finish_unsaved();

 private:
  /// A sample whose scene is not known yet.
  struct UnknownScene {
    std::size_t tick;
    std::uint64_t number;
  };
  Status record(std::size_t tick, const SceneParameters& parameters);
  Status written(Status status);
  RunResult score();

  AttemptRecord(const Case& the_case, storage::SessionInfo info, storage::SessionWriter writer,
                std::size_t expected_ticks);

  const Case* the_case_;
  storage::SessionInfo info_;
  storage::SessionWriter writer_;
  std::vector<telemetry::TickSample> samples_;
  std::optional<std::size_t> fired_;
  std::vector<storage::TransducerSample> transducer_;  ///< Those that were kept.
  std::vector<storage::SessionParameters> parameter_rows_;
  std::optional<Error> write_failure_;
  SceneParameters parameters_;                   ///< Recorded last.
  std::optional<anatomy::TissueTable> tissues_;  ///< Their table; none: nothing was recorded yet.
  std::uint64_t scene_ = 0;                      ///< Of the last sample.
  std::vector<UnknownScene> unknown_;            ///< By tick.
  bool has_lost_scene_ = false;                  ///< The parameters of some ticks were never told.
  std::vector<tasks::Interruption> interruptions_;
};

}  // namespace trocar::attempt
