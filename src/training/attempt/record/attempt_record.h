#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/record/known_scenes.h"
#include "attempt/record/run_result.h"
#include "cases/prepare_case.h"
#include "tasks/operator.h"

namespace trocar::attempt {

/// Description of how an attempt was made, in addition to case and options.
struct AttemptFacts {
  std::string device;  ///< In words.
  double rate_hz = 1000.0;
  std::string force_model;
  std::string device_preset;   ///< Of data/devices.toml; empty: none of them.
  SceneParameters parameters;  ///< In force when it begins, as far as known; no table: the case's.
  std::string level = {};      ///< See SessionInfo.
};

/// Where an attempt is recorded, and what is recorded of its choice.
struct RecordOptions {
  std::filesystem::path session;  ///< Written here; must not exist.
  std::string operator_name;
  std::string patient_source;  ///< As the user named it: a folder, or an embedded patient's name.
  std::uint64_t patient_seed = 1;
  std::uint64_t seed = 1;
};

/// The preset of a server's device: "premium" of "virtual:premium"; empty: it is none of data/devices.toml.
std::string preset_of_device(std::string_view device_name);

/// Maximum rate of recorded transducer poses: a hand moves 0.6 mm in that time, tremor has 8 to 12 Hz, a screen shows
/// 60 frames a second. Increases the file by about 5 %; recording every tick would increase it by half.
inline constexpr double kTransducerEvery_s = 0.01;

/// A running attempt: every tick in memory and in the session file, scored at the end. Appended ticks are in the file
/// even if the attempt fails.
class AttemptRecord {
 public:
  /// The case must outlive it. Errors: the session file.
  static Result<AttemptRecord> create(const cases::Case& the_case, const RecordOptions& options,
                                      const AttemptFacts& facts);

  /// What the operator does before the next tick: fires, perhaps.
  void note(const tasks::HandCommand& command) noexcept;
  Status append(const telemetry::TickSample& sample);
  /// Parameters of the last appended sample; recorded when they change.
  Status note_parameters(const SceneParameters& parameters);
  /// The same of the scene of a server by its number. One that is not known yet is recorded later, by another call.
  Status note_scene(std::uint64_t number, const KnownScenes& known);
  /// Call when a server is replaced: scene numbers start again.
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
  /// Call after such a failure: scores the recorded part and reports how much the file lacks.
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

  AttemptRecord(const cases::Case& the_case, storage::SessionInfo info, storage::SessionWriter writer,
                std::size_t expected_ticks);

  const cases::Case* the_case_;
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
  bool has_lost_scene_ = false;                  ///< Some ticks have no reported parameters.
  std::vector<tasks::Interruption> interruptions_;
};

}  // namespace trocar::attempt
