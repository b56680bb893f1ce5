#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/record/run_result.h"
#include "core/clock.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "link/messages.h"
#include "tasks/operator.h"

namespace trocar::attempt {

class HapticServers;

/// Tool held by a hand.
enum class Tool : std::uint8_t { kNeedle, kProbe };

/// Requests of a client to the attempt, between two polls of its loop.
struct AttemptRequests {
  struct Goal {
    Pose X_P;
    Vec3 v_P = Vec3::Zero(), w_P = Vec3::Zero();
  };
  std::optional<Goal> needle, probe;
  std::optional<bool> needle_clamped, probe_clamped;
  std::optional<bool> stopped;
  std::vector<link::SetParameters> parameters;  ///< Messages, in order.
  std::unique_ptr<tasks::Operator> performer;
  bool begins = false, fires = false, finishes = false, has_drawn = false;
};

/// What the loop publishes after each poll.
struct AttemptUpdate {
  AttemptView view;
  std::vector<ForcePoint> forces;    ///< Since the last one.
  std::vector<AttemptEvent> events;  ///< Since the last one.
  std::optional<Result<RunResult>> result;
  std::shared_ptr<HapticServers> servers;
};

/// Requests in, updates out: all that a client and the loop of an attempt share. Both may be on threads of their own; a
/// mutex is held for copies only.
class AttemptExchange {
 public:
  explicit AttemptExchange(std::shared_ptr<const Clock> clock) : clock_(std::move(clock)) {}

  // The client's side. One thread.
  AttemptView view() const;
  /// Of the recorded session since the last call, thinned to the resolution of a plot; no peak is lost.
  std::vector<ForcePoint> take_forces();
  std::vector<AttemptEvent> take_events();
  /// Once, in kFinished or kFailed.
  std::optional<Result<RunResult>> take_result();
  /// For the next attempt; null before they were started.
  std::shared_ptr<HapticServers> servers() const;

  /// The window has drawn a picture. Once called, the servers receive the age of the last one.
  void frame_drawn();
  /// Target pose and velocity (mm/s of tip or face, rad/s) of a hand. A hand without an update for 50 ms stops; a jump
  /// is slowed down to possible hand motion. While there are no data from the needle (kServerLost), targets are
  /// ignored.
  void set_goal(Tool tool, const Pose& X_PTool, const Vec3& v_P = Vec3::Zero(), const Vec3& w_P = Vec3::Zero());
  /// Clamped: the tool stays in place and ignores set_goal.
  void clamp(Tool tool, bool is_clamped);
  void begin();  ///< See AttemptOptions::waits_for_begin.
  void fire();   ///< The biopsy gun; counts once.
  void stop_forces();
  void resume_forces();
  /// To the servers while they run; the insertion continues. The loaded table is the case's. The server's reply is the
  /// view's message.
  void set_parameters(link::SetParameters parameters);
  /// A scripted operator moves the needle, after the hand has gone to its start; the view's is_performing tells how
  /// long.
  void perform(std::unique_ptr<tasks::Operator> the_operator);
  /// Ends the attempt and scores it. Without a single tick it fails.
  void finish();

  // The loop's side.
  AttemptRequests take_requests();
  void publish(AttemptUpdate update);

 private:
  std::shared_ptr<const Clock> clock_;
  mutable std::mutex mutex_;
  AttemptRequests requests_;
  AttemptUpdate update_;
  Clock::TimePoint published_;
};

}  // namespace trocar::attempt
