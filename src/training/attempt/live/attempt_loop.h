#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/live/attempt_exchange.h"
#include "attempt/live/detail/force_trace.h"
#include "attempt/live/live_operator.h"
#include "attempt/live/needle_steering.h"
#include "attempt/servers/haptic_servers.h"
#include "attempt/tools/transducer_motion.h"
#include "cases/prepare_case.h"

namespace trocar::attempt {

/// The case of an attempt as the loop needs it.
struct AttemptCase {
  std::shared_ptr<const cases::Case> the_case;
  std::string patient_source;  ///< As the user named it; recorded.
  std::string server_source;   ///< As a server of this machine opens it.
  std::uint64_t patient_seed = 1;
};

/// Who moves the tools.
struct AttemptOperators {
  /// Its operator performs from the first tick; null: the client leads the needle. Its parameters are sent at their
  /// ticks.
  Performer needle;
  bool ends_with_operator = false;
  std::unique_ptr<TransducerMotion> transducer;  ///< Null: the client leads it.
};

struct LoopOptions {
  std::filesystem::path session;  ///< Written here; must not exist. Its folder must.
  std::string operator_name;      ///< Recorded.
  std::string level;              ///< Recorded.
  std::uint64_t seed = 1;
  Pose X_PN_start;  ///< Of a needle that the client leads.
  Pose X_PT_start;  ///< Of a transducer that the client leads.
  bool waits_for_begin = false;
  bool is_guided = false;      ///< Hints are given.
  bool has_view = true;        ///< false: phase, progress and time alone are published.
  double longest_s = 900.0;    ///< Every tick is kept in memory until it is scored. [assumed]
  bool scores_unsaved = true;  ///< A session that cannot be written is scored all the same; false: it is an error.
  bool is_transducer_optional = true;  ///< The attempt begins also without a transducer's server.
  /// A failure of the needle's server ends the attempt also after it began, and notes do not list recoveries.
  bool ends_with_needle_server = false;
  /// Asked about the session's folder once a second while it is recorded; empty: the disk is not watched.
  std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)> free_bytes;
};

/// An attempt through live haptic servers, one step at a time: records every needle tick, responds to it, supervises
/// the servers, and scores at the end. The only live loop: a window runs it on a thread of its own (LiveAttempt), the
/// command line on its caller's (run_realtime_session). One thread; only restarting a server's process and the end
/// block.
class AttemptLoop {
 public:
  /// Clock and exchange must outlive it.
  AttemptLoop(AttemptCase the_case, LoopOptions options, AttemptOperators operators,
              std::shared_ptr<HapticServers> servers, ToolSupervisors supervisors, Clock& clock,
              AttemptExchange& exchange);

  /// One step; call it every 1 to 2 ms. false: the attempt has ended, its result is in the exchange.
  bool poll();
  /// Switches the forces off and ends it without a score; the session stays, incomplete.
  void abandon();

 private:
  // attempt_loop.cpp
  void prepare();
  Status step();
  void take_requests();
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
  void answer_unrecorded(const std::vector<link::NumberedSample>& samples);
  Status record(const std::vector<link::NumberedSample>& samples);
  void note_tick(const telemetry::TickSample& sample);
  void note_shot();
  void send_scheduled_parameters();
  Status step_transducer();

  // attempt_publish.cpp
  AttemptPhase phase_now() const;
  NeedleView needle_now() const;
  TransducerView transducer_now() const;
  void add_servers(AttemptView& view) const;
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
  TransducerMotion* transducer_motion_ = nullptr;  ///< One of these two.
  std::optional<AttemptRecord> record_;
  std::optional<LiveOperator> live_;
  tasks::HandCommand command_;       ///< Of the needle's hand.
  std::size_t next_parameters_ = 1;  ///< Of the performer's; the first ones are the scene's.
  std::optional<telemetry::TickSample> last_needle_, last_transducer_;
  double needle_time_s_ = 0.0, transducer_time_s_ = 0.0;     ///< Of the servers' last ticks.
  double transducer_on_s_ = 0.0;                             ///< When its forces came on.
  int needle_activations_ = 0, transducer_activations_ = 0;  ///< When their ticks last began to come.
  bool was_needle_on_ = false, was_transducer_on_ = false;
  bool is_transducer_given_up_ = false;  ///< And noted.
  bool begins_ = false, finishes_ = false, is_stopped_ = false;
  bool has_ever_been_on_ = false, has_ended_ = false;
  std::optional<double> contact_s_;
  double session_s_ = 0.0, since_contact_s_ = 0.0;  ///< Active time; kept for the view after the record is closed.
  ForceTrace trace_;
  Clock::TimePoint disk_polled_;
  std::string disk_banner_, cut_short_;
  std::vector<AttemptEvent> events_;
  std::shared_ptr<const GunShot> shot_;
  std::vector<std::string> notes_;
  std::string message_, progress_, recovered_;
  int recoveries_ = 0;
  double progress_fraction_ = 0.0;
};

}  // namespace trocar::attempt
