#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/record/score_session.h"
#include "core/clock.h"
#include "core/live/feed.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "link/messages.h"
#include "tasks/action.h"
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
  std::vector<tasks::XrayUse> xray;           ///< In order.
  std::vector<tasks::ActionRequest> actions;  ///< In order.
  std::optional<std::size_t> repeated_phase;
  bool finishes = false, has_drawn = false;
};

/// Data that the loop publishes after each poll.
struct AttemptUpdate {
  AttemptView view;
  std::vector<ForcePoint> forces;    ///< Since the last update.
  std::vector<AttemptEvent> events;  ///< Since the last update.
  std::optional<Result<RunResult>> result;
  std::shared_ptr<HapticServers> servers;
};

/// Requests and updates: the only data that a client and the loop of an attempt share. Each may run on its own thread;
/// the mutex is held for copies only. The states of the attempt are a feed, for any number of readers on any threads.
class AttemptExchange {
 public:
  explicit AttemptExchange(std::shared_ptr<const Clock> clock) : clock_(std::move(clock)) {}

  /// The states of the attempt, one a poll of the loop, as it published them.
  const Feed<AttemptView>& states() const noexcept { return states_; }

  // Client side; one thread.
  /// The newest state with its age (see aged()) and the effect of requests that the loop has not answered yet.
  AttemptView view() const;
  /// Forces of the recorded session since the last call, thinned to the resolution of a plot; all peaks are kept.
  std::vector<ForcePoint> take_forces();
  std::vector<AttemptEvent> take_events();
  /// Returns the result once, in kFinished or kFailed.
  std::optional<Result<RunResult>> take_result();
  /// Servers for the next attempt; null before they were started.
  std::shared_ptr<HapticServers> servers() const;

  /// Call after the window has drawn a frame. After the first call the servers receive the age of the last frame.
  void frame_drawn();
  /// Target pose and velocity (mm/s of tip or face, rad/s) of a hand. A hand without an update for 50 ms stops; a jump
  /// is slowed down to possible hand motion. While there are no data from the needle (kServerLost), targets are
  /// ignored.
  void set_goal(Tool tool, const Pose& X_PTool, const Vec3& v_P = Vec3::Zero(), const Vec3& w_P = Vec3::Zero());
  /// Clamped: the tool stays in place and ignores set_goal.
  void clamp(Tool tool, bool is_clamped);
  void stop_forces();
  void resume_forces();
  /// Use of the fluoroscope, which the recording keeps; its time is set by the attempt.
  void note_xray(const tasks::XrayUse& use);
  /// An action besides moving tools; it happens at the newest tick. Ignored before the attempt, and where it is
  /// impossible: firing an empty gun.
  void act(const tasks::ActionRequest& request);
  /// Opens a phase of the task again, and those that follow from it: to practise it once more.
  void repeat_phase(std::size_t phase);
  /// Sends parameters to the servers while they run; the insertion continues. The loaded table is the case's. The
  /// view's message is the server's reply.
  void set_parameters(link::SetParameters parameters);
  /// A scripted operator moves the needle after the hand has moved to the operator's start. The view's is_performing is
  /// true until the operator has finished.
  void perform(std::unique_ptr<tasks::Operator> the_operator);
  /// Ends the attempt and scores it. Fails without any tick.
  void finish();

  // Loop side.
  AttemptRequests take_requests();
  void publish(AttemptUpdate update);

 private:
  std::shared_ptr<const Clock> clock_;
  mutable std::mutex mutex_;
  AttemptRequests requests_;
  /// Requested, and not part of the newest state yet.
  std::optional<bool> stopped_;
  bool performs_ = false;
  AttemptUpdate untaken_;  ///< Its view is not used.
  Feed<AttemptView> states_;
};

}  // namespace trocar::attempt
