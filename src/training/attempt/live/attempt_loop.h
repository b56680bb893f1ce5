#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "attempt/live/attempt_exchange.h"
#include "attempt/live/attempt_view.h"
#include "attempt/live/attempt_watch.h"
#include "attempt/live/live_operator.h"
#include "attempt/record/attempt_record.h"
#include "attempt/servers/haptic_servers.h"
#include "attempt/tools/tool_motion.h"
#include "cases/prepare_case.h"

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

/// Parts of an AttemptLoop.
namespace live {

/// A tool's server and what came of it.
struct LiveTool {
  std::unique_ptr<ServerSupervisor> server;  ///< Null: there is none.
  std::optional<telemetry::TickSample> last;
  double time_s = 0.0;  ///< Time of the server's last tick.
  int activations = 0;  ///< ServerSupervisor::activations() when its ticks last began to arrive.
  bool was_on = false;  ///< At the last poll.
};

/// What the program does now, for a progress bar.
struct Activity {
  std::string step;
  double fraction = 0.0;  ///< 0..1
};

// The states of an attempt, in their order. A lost server is none of them: its supervisor brings it back.

/// The servers start, load their scenes and switch their forces on. Nothing is recorded.
struct Preparing {};
/// From the moment at which the forces of all tools are on.
struct Recording {
  /// The performer must outlive it.
  Recording(const Performer& performer, AttemptRecord begun, const tasks::HandCommand& first, double longest_s)
      : record(std::move(begun)), live(performer, record, first, longest_s) {}

  AttemptRecord record;
  LiveOperator live;
  std::optional<AttemptWatch> watch;  ///< Empty: nobody watches.
  Clock::TimePoint disk_polled;
  std::string disk_banner, cut_short;
};
/// The result is in the exchange, the session's file is closed.
struct Ended {};

}  // namespace live

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
  using LiveTool = live::LiveTool;
  using Activity = live::Activity;
  using Preparing = live::Preparing;
  using Recording = live::Recording;
  using Ended = live::Ended;

  // attempt_loop.cpp
  void prepare();
  Status step();
  Status take_requests();
  Status take_requests(Recording& recording, AttemptRequests& requests);
  void ask_patient(tasks::ActionKind action);
  Status act(Recording& recording, const tasks::ActionRequest& request);
  bool is_needle_free() const;
  void lead(const AttemptRequests& requests);
  void stop_or_resume(bool is_stopped);
  void poll_server(ServerSupervisor& server);
  Status check_servers();
  Activity preparation() const;
  Status start_recording();
  void watch_disk(Recording& recording);
  void conclude(const Status& status);
  Result<RunResult> score(const Status& status);

  // attempt_loop_tools.cpp
  Status step_needle();
  void note_place(const telemetry::TickSample& sample);
  void answer_unrecorded(const std::vector<link::NumberedSample>& samples);
  Status record(Recording& recording, const std::vector<link::NumberedSample>& samples);
  void send_scheduled_parameters(const AttemptRecord& record);
  Status step_transducer();

  // attempt_publish.cpp
  AttemptPhase phase_now() const;
  motion::PatientMotion motion_now();
  NeedleView needle_now() const;
  TransducerView transducer_now() const;
  void add_servers(AttemptView& view) const;
  AttemptUpdate compose(AttemptPhase phase, Activity activity);
  void publish(AttemptPhase phase, Activity activity = {}) { exchange_.publish(compose(phase, std::move(activity))); }

  bool is_preparing() const noexcept { return std::holds_alternative<Preparing>(state_); }
  Recording* recording() noexcept { return std::get_if<Recording>(&state_); }
  const Recording* recording() const noexcept { return std::get_if<Recording>(&state_); }

  AttemptCase case_;
  LoopOptions options_;
  Clock& clock_;
  AttemptExchange& exchange_;
  std::shared_ptr<HapticServers> servers_;  ///< Outlives the supervisors.
  LiveTool needle_, transducer_;

  Performer performer_;
  NeedleSteering* steering_ = nullptr;  ///< The performer's operator.
  tasks::HandCommand command_;          ///< Command of the needle's hand.
  std::size_t next_parameters_ = 1;  ///< Index into the performer's parameters; the first ones are part of the scene.
  telemetry::NeedleShape needle_shape_;  ///< The newest one.
  double pressed_mm_ = 0.0;              ///< Largest of this insertion, see note_place.
  motion::MotionDrive breathing_;        ///< What moves the patient, in the time of clock_.
  motion::MotionDrive drive_;            ///< Of the needle's newest scene, drive_scene_.
  std::uint64_t drive_scene_ = 0;

  LedTransducer led_transducer_;
  std::unique_ptr<TransducerMotion> own_motion_;
  TransducerMotion* transducer_motion_ = nullptr;  ///< Points to one of these two.
  double transducer_on_s_ = 0.0;                   ///< Time at which the transducer's forces were switched on.
  bool is_transducer_given_up_ = false;            ///< With a note.

  std::variant<Preparing, Recording, Ended> state_;
  bool finishes_ = false;    ///< The attempt ends with this poll.
  bool is_stopped_ = false;  ///< The trainee stopped the forces.
  std::vector<std::string> notes_;
  std::string message_, recovered_;
  int recoveries_ = 0;
};

}  // namespace trocar::attempt
