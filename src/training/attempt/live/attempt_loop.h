#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/live/attempt_exchange.h"
#include "attempt/live/attempt_view.h"
#include "attempt/live/live_operator.h"
#include "attempt/record/attempt_record.h"
#include "attempt/servers/haptic_servers.h"
#include "attempt/tools/tool_motion.h"
#include "cases/prepare_case.h"
#include "metrics/harm_watch.h"
#include "scoring/pain.h"
#include "scoring/phase_tracker.h"

namespace trocar::attempt {

/// Case of an attempt, for the loop.
struct AttemptCase {
  std::shared_ptr<const cases::Case> the_case;
  std::string server_source;                 ///< Source for a server of this machine.
  std::optional<metrics::ImagePlane> plane;  ///< Of the transducer; empty: there is none.
};

/// Operators that move the tools.
struct AttemptOperators {
  /// The operator performs from the first tick; null: the client leads the needle. Its parameters are sent at their
  /// ticks.
  Performer needle;
  bool ends_with_operator = false;
  std::unique_ptr<TransducerMotion> transducer;  ///< Null: the client leads it.
};

struct LoopOptions : AttemptIdentity {
  std::filesystem::path session;  ///< Written here; must not exist. Its folder must.
  Pose X_PN_start;                ///< Start pose of a needle that the client leads.
  Pose X_PT_start;                ///< Start pose of a transducer that the client leads.
  bool is_guided = false;         ///< Hints are given.
  bool has_view = true;           ///< false: only phase, progress and time are published.
  /// Limit of the duration: every tick stays in memory until the attempt is scored. [assumed]
  double longest_s = 900.0;
  bool scores_unsaved = true;  ///< true: a session that cannot be written is still scored; false: it is an error.
  bool is_transducer_optional = true;  ///< The attempt also begins without a server of the transducer.
  /// A failure of the needle's server ends the attempt even after its begin; notes do not list recoveries.
  bool ends_with_needle_server = false;
  /// Called with the session's folder once a second during recording; empty: the disk is not monitored.
  std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)> free_bytes;
};

/// An attempt through live haptic servers, one step at a time: records every needle tick, responds to it, supervises
/// the servers, and scores at the end. This is the only live loop: a window runs it on a separate thread (LiveAttempt),
/// the command line on the caller's thread (run_realtime_session). Single-threaded. Only the restart of a server's
/// process and the end of the attempt block.
class AttemptLoop {
 public:
  /// Clock and exchange must outlive it.
  AttemptLoop(AttemptCase the_case, LoopOptions options, AttemptOperators operators,
              std::shared_ptr<HapticServers> servers, ToolSupervisors supervisors, Clock& clock,
              AttemptExchange& exchange);

  /// Performs one step; call it every 1 to 2 ms. false: the attempt has ended, its result is in the exchange.
  bool poll();
  /// Switches the forces off and ends the attempt without a score; the incomplete session is kept.
  void abandon();
  /// Ends an attempt that the trainee leaves: it is scored as it is if the needle was in the body, so that leaving is
  /// no way not to be counted; otherwise it is abandoned.
  void leave();

 private:
  // attempt_loop.cpp
  void prepare();
  Status step();
  Status take_requests();
  Status act(const tasks::ActionRequest& request);
  bool is_needle_free() const;
  void lead(const AttemptRequests& requests);
  void stop_or_resume(bool is_stopped);
  void poll_server(ServerSupervisor& server);
  Status check_servers();
  Status start_recording();
  void watch_disk();
  void conclude(const Status& status);
  Result<RunResult> score(const Status& status);

  // attempt_loop_tools.cpp
  Status step_needle();
  void note_place(const telemetry::TickSample& sample);
  void answer_unrecorded(const std::vector<link::NumberedSample>& samples);
  Status record(const std::vector<link::NumberedSample>& samples);
  Status note_shape(const link::NumberedSample& numbered);
  void note_tick(const telemetry::TickSample& sample);
  void note_harm(const telemetry::TickSample& sample);
  void note_contrast(const tasks::XrayUse& use);
  /// Tells of an injection when it has ended.
  void tell_injection();
  void note_shots();
  void note_actions();
  void step_phases();
  std::string hint_of(const AttemptView& view) const;
  void add_phases(AttemptView& view) const;
  void send_scheduled_parameters();
  Status step_transducer();

  // attempt_publish.cpp
  AttemptPhase phase_now() const;
  motion::PatientMotion motion_now();
  NeedleView needle_now() const;
  TransducerView transducer_now() const;
  void add_servers(AttemptView& view) const;
  void add_harm(AttemptView& view) const;
  void add_times(AttemptView& view);
  void publish(AttemptPhase phase, std::optional<Result<RunResult>> result = {});

  AttemptCase case_;
  LoopOptions options_;
  Clock& clock_;
  AttemptExchange& exchange_;
  std::shared_ptr<HapticServers> servers_;  ///< Outlives the supervisors.
  std::unique_ptr<ServerSupervisor> needle_, transducer_;
  Performer performer_;
  NeedleSteering* steering_ = nullptr;  ///< The performer's operator.
  LedTransducer led_transducer_;
  std::unique_ptr<TransducerMotion> own_motion_;
  TransducerMotion* transducer_motion_ = nullptr;  ///< Points to one of these two.
  std::optional<AttemptRecord> record_;
  std::optional<LiveOperator> live_;
  tasks::HandCommand command_;       ///< Command of the needle's hand.
  std::size_t next_parameters_ = 1;  ///< Index into the performer's parameters; the first ones are part of the scene.
  std::optional<telemetry::TickSample> last_needle_, last_transducer_;
  motion::MotionDrive drive_;  ///< Of the needle's newest scene, drive_scene_.
  std::uint64_t drive_scene_ = 0;
  telemetry::NeedleShape needle_shape_;                   ///< The newest one.
  double needle_time_s_ = 0.0, transducer_time_s_ = 0.0;  ///< Times of the servers' last ticks.
  double transducer_on_s_ = 0.0;                          ///< Time at which the transducer's forces were switched on.
  /// ServerSupervisor::activations() when their ticks last began to arrive.
  int needle_activations_ = 0, transducer_activations_ = 0;
  double pressed_mm_ = 0.0;  ///< Largest of this insertion, see note_place.
  bool was_needle_on_ = false, was_transducer_on_ = false;
  bool is_transducer_given_up_ = false;  ///< The transducer was given up, with a note.
  bool finishes_ = false, is_stopped_ = false;
  bool has_ever_been_on_ = false, has_ended_ = false;
  std::optional<double> contact_s_;
  double session_s_ = 0.0, since_contact_s_ = 0.0;  ///< Active time; kept for the view after the record is closed.
  ForceTrace trace_;
  Clock::TimePoint disk_polled_;
  std::string disk_banner_, cut_short_;
  std::vector<AttemptEvent> events_;
  std::shared_ptr<const GunShot> shot_;  ///< The last one.
  std::size_t told_shots_ = 0;
  std::size_t cores_ = 0;                   ///< Taken so far.
  std::optional<scoring::PainWatch> pain_;  ///< From the begin of the recording.
  std::optional<metrics::HarmWatch> harm_;  ///< From the begin of the recording.
  std::optional<metrics::HarmEvent>
      told_harm_;  ///< The last critical or major one, with the time at which it was told.
  double told_harm_s_ = 0.0;
  std::optional<scoring::PhaseTracker> phases_;  ///< From the begin of the recording.
  double phases_s_ = 0.0;                        ///< Time of its last step.
  double contrast_ml_ = 0.0;
  std::optional<tasks::ContrastInjection> injection_;  ///< Not told yet.
  std::size_t told_actions_ = 0;                       ///< Number of the record's actions that are among the events.
  std::vector<std::string> notes_;
  std::string message_, progress_, recovered_;
  int recoveries_ = 0;
  double progress_fraction_ = 0.0;
};

}  // namespace trocar::attempt
