#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attempt/record/known_scenes.h"
#include "attempt/record/score_session.h"
#include "cases/prepare_case.h"
#include "metrics/metric.h"
#include "tasks/operator.h"

namespace trocar::attempt {

/// Which attempt it is: given once, where it is begun, and carried whole to the session and the results.
struct AttemptIdentity {
  std::string attempt_id;      ///< Empty: a new one.
  std::string person_id;       ///< Who practises; empty: nobody was chosen. See storage::SessionInfo.
  std::string operator_name;   ///< "trainee", or a scripted operator: "expert" …
  std::string level;           ///< Of help, in a window: "guided", "assisted", "exam".
  std::string patient_source;  ///< As given by the user: a folder, or an embedded patient's name.
  std::uint64_t patient_seed = 1;
  std::uint64_t seed = 1;  ///< Of operator, friction and plan.

  const AttemptIdentity& identity() const noexcept { return *this; }
  AttemptIdentity& identity() noexcept { return *this; }
};

/// The fields of a session that tell which attempt of which case it is.
storage::SessionInfo identify(const cases::Case& the_case, const AttemptIdentity& identity);

/// Description of how an attempt was made, in addition to case and options.
struct AttemptFacts {
  std::string device;  ///< Description.
  double rate_hz = 1000.0;
  std::string force_model;
  std::string device_preset;   ///< Name in data/devices.toml; empty: not listed there.
  SceneParameters parameters;  ///< Parameters at the begin, as far as known; without a table: the case's table.
};

/// File of a recorded attempt, and the options that are recorded.
struct RecordOptions : AttemptIdentity {
  std::filesystem::path session = {};             ///< Written here; must not exist.
  std::optional<metrics::ImagePlane> plane = {};  ///< Of the transducer; empty: none.
  /// Address space for the ticks of this time is reserved: growing copies all of them, which interrupts a live loop.
  double longest_s = 30.0;
};

/// Preset of a server's device: "premium" of "virtual:premium"; empty: not in data/devices.toml.
std::string preset_of_device(std::string_view device_name);

/// Shortest interval between recorded transducer poses: a hand moves 0.6 mm in that time, tremor has 8 to 12 Hz, a
/// screen shows 60 frames a second. These poses increase the file by about 5 %; recording every tick would increase it
/// by half.
inline constexpr double kTransducerEvery_s = 0.01;

/// A running attempt: every tick in memory and in the session file, scored at the end. Appended ticks are in the file
/// even if the attempt fails.
class AttemptRecord {
 public:
  /// The case must outlive it. Errors: the session file.
  static Result<AttemptRecord> create(const cases::Case& the_case, const RecordOptions& options,
                                      const AttemptFacts& facts);

  /// Notes what the operator does with the next tick: a shot or another action, if any.
  void note(const tasks::HandCommand& command) noexcept;
  Status append(const telemetry::TickSample& sample);
  /// Does an action at the last sample: what comes back depends on where the tip is. Empty before the first sample.
  Result<std::optional<tasks::Action>> act(const tasks::ActionRequest& request);
  /// Appends a recorded action as it was; for the replay of a session.
  Status append(const tasks::Action& action);
  const std::vector<tasks::Action>& actions() const noexcept { return session_.actions; }
  /// Notes the parameters of the last appended sample; they are recorded when they change.
  Status note_parameters(const SceneParameters& parameters);
  /// The same for a server's scene, by its number. A later call records the parameters of a scene that is not known
  /// yet.
  Status note_scene(std::uint64_t number, const KnownScenes& known);
  /// Call when a server is replaced: scene numbers start again.
  void forget_scenes() noexcept;
  /// Call before the first sample after the interruption.
  Status append(const tasks::Interruption& interruption);
  const std::vector<tasks::Interruption>& interruptions() const noexcept { return session_.interruptions; }
  /// Shape of the needle, in session time. Kept if it differs from the last one by more than kShapeStep_mm. The score
  /// does not depend on it.
  Status append(const telemetry::NeedleShape& shape);
  static constexpr double kShapeStep_mm = 0.02;
  /// At most one sample per kTransducerEvery_s is kept. The score does not depend on it.
  Status append(const storage::TransducerSample& sample);
  /// Kept if it differs from the last one. The score depends on the last one's dose.
  Status append(const tasks::XrayUse& use);
  const storage::SessionInfo& info() const noexcept { return session_.info; }
  const std::vector<telemetry::TickSample>& samples() const noexcept { return session_.samples; }  ///< Samples so far.
  /// Indices of the samples at which the gun was fired.
  const std::vector<std::size_t>& shots() const noexcept { return session_.shots; }
  /// Scores the attempt and closes the session file.
  Result<RunResult> finish(const Progress& progress = {});
  /// The first failure to write the session file; empty: no failure.
  const std::optional<Error>& write_failure() const noexcept { return write_failure_; }
  /// Call after such a failure: scores the recorded part and reports how much the file lacks.
  RunResult finish_unsaved(const Progress& progress = {});

 private:
  /// A sample whose scene is not known yet.
  struct UnknownScene {
    std::size_t tick;
    std::uint64_t number;
  };
  Status record(std::size_t tick, const SceneParameters& parameters);
  Status written(Status status);
  bool is_possible(tasks::ActionKind kind, double depth_mm) const noexcept;
  RunResult score(const Progress& progress);
  double wire_way_mm(const telemetry::TickSample& sample, double wanted_mm) const;

  AttemptRecord(const cases::Case& the_case, storage::SessionInfo info, storage::SessionWriter writer,
                std::size_t expected_ticks);

  const cases::Case* the_case_;
  storage::Session session_;  ///< What is kept.
  storage::SessionWriter writer_;
  std::optional<tasks::ActionRequest> wanted_action_;  ///< With the next sample.
  std::optional<Error> write_failure_;
  SceneParameters parameters_;                   ///< Last recorded parameters.
  std::optional<anatomy::TissueTable> tissues_;  ///< Table of parameters_; none: nothing was recorded yet.
  std::uint64_t scene_ = 0;                      ///< Scene number of the last sample.
  std::vector<UnknownScene> unknown_;            ///< Ordered by tick.
  bool has_lost_scene_ = false;                  ///< Some ticks have no reported parameters.
};

}  // namespace trocar::attempt
