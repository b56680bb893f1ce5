#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "attempt/hands/resting_transducer.h"
#include "attempt/live/detail/force_trace.h"
#include "attempt/live/live_attempt.h"
#include "attempt/live/live_operator.h"
#include "attempt/live/needle_steering.h"
#include "attempt/servers/detail/tool_server.h"

namespace trocar::attempt {

/// What the window asks of the attempt between two looks of its thread.
struct AttemptWishes {
  struct Lead {
    Pose X_P;
    Vec3 v_P = Vec3::Zero(), w_P = Vec3::Zero();
  };
  std::optional<Lead> needle, probe;
  std::optional<bool> needle_clamped, probe_clamped;
  std::optional<bool> stopped;
  std::vector<std::vector<std::string>> settings;  ///< Messages, in order.
  std::unique_ptr<tasks::Operator> performer;
  bool begins = false, fires = false, finishes = false, has_drawn = false;
};

/// What goes from the attempt's thread to the window.
struct AttemptNews {
  AttemptView view;
  Clock::TimePoint told;  ///< When the view was made.
  std::vector<ForcePoint> forces;
  std::vector<AttemptEvent> events;
  std::optional<Result<RunResult>> result;
  std::shared_ptr<SeatServers> servers;
};

/// What both threads share; locked for copies only.
struct AttemptDesk {
  std::mutex mutex;
  AttemptWishes wishes;
  AttemptNews news;
};

/// The attempt itself, all on one thread.
class AttemptLoop {
 public:
  AttemptLoop(std::shared_ptr<const cases::OpenCase> open_case, const AttemptOptions& options,
              std::shared_ptr<SeatServers> servers, AttemptDesk& desk);
  /// Until it is finished, has failed, or is told to stop.
  void run(const std::stop_token& stop);

 private:
  Status start();
  Status step();
  Status take_wishes();
  void lead_hands(const AttemptWishes& wishes);
  void stop_or_resume(bool is_stopped);
  Status start_recording();
  Status step_needle();
  void answer_unrecorded(const std::vector<link::NumberedSample>& samples);
  Status record(const std::vector<link::NumberedSample>& samples);
  void note_tick(const telemetry::TickSample& sample);
  void note_shot();
  Status step_probe();
  void look_at(ToolServer& server);
  Status check_start();
  void watch_disk();
  void conclude(Status status);
  Result<RunResult> score(const Status& status);

  AttemptPhase phase_now() const;
  NeedleView needle_now() const;
  TransducerView probe_now() const;
  void publish(AttemptPhase phase, std::optional<Result<RunResult>> result = {});

  std::shared_ptr<const cases::OpenCase> open_case_;
  AttemptOptions options_;
  std::shared_ptr<SeatServers> servers_;
  AttemptDesk& desk_;
  std::optional<ToolServer> needle_, probe_;
  Performer performer_;
  SteeredNeedle* steering_ = nullptr;  ///< The performer's operator.
  LedHand probe_hand_{kSteeredHand};
  std::optional<AttemptRecord> record_;
  std::optional<LiveOperator> live_;
  tasks::HandCommand command_;  ///< Of the needle's hand.
  std::optional<telemetry::TickSample> last_needle_, last_probe_;
  double probe_time_s_ = 0.0, needle_time_s_ = 0.0;  ///< Of the servers' last ticks.
  int seatings_ = 0;                                 ///< Of the needle's server, when its ticks last began to come.
  bool was_needle_on_ = false, was_probe_on_ = false;
  bool begins_ = false, finishes_ = false, is_stopped_ = false;
  bool has_ever_been_on_ = false;
  std::optional<double> contact_s_;
  double session_s_ = 0.0, since_contact_s_ = 0.0;  ///< Active time: kept for the view after the record is closed.
  ForceTrace trace_;
  Clock::TimePoint disk_looked_at_;
  std::string disk_banner_, cut_short_;
  std::vector<AttemptEvent> events_;
  std::shared_ptr<const GunShot> shot_;
  std::vector<std::string> notes_;
  std::string message_, progress_, recovered_;
  int recoveries_ = 0;
  double progress_fraction_ = 0.0;
};

}  // namespace trocar::attempt
