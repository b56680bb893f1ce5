#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/record/known_scenes.h"
#include "attempt/record/run_result.h"
#include "attempt/servers/server_connection.h"
#include "core/clock.h"

namespace trocar::attempt {

/// Scene of a server, and the initial hand pose: at rest, and rigid until the forces are on.
struct SeatRequest {
  link::LoadScene scene;
  link::HandTarget place;
  /// A person's hand holds the device: its pose is not set, and forces start at its present pose.
  bool is_in_real_hand = false;
  bool resets_fault = false;  ///< Resets a fault that was latched before the connection.
  /// Differences from the scene's numbers; applied before the forces are switched on. Empty: not sent.
  link::SetParameters parameters = {};
};

/// Client-side state machine of one haptic server: connects, loads the scene, places the hand, switches the forces on;
/// then the attempt moves the hand. A server that reconnects, or whose loop stalled, repeats these steps; its fault is
/// reset unless a person's hand holds the device. Nothing blocks: call look() about every millisecond; time without
/// calls does not count as a timeout.
class ServerSeat {
 public:
  enum class State { kConnecting, kReady, kLoading, kPlacing, kStarting, kSettling, kOn };

  /// `endpoint` is for messages. The clock must outlive this.
  ServerSeat(std::unique_ptr<ServerConnection> connection, std::string endpoint, std::chrono::milliseconds patience,
             Clock& clock);

  /// Sets the scene; before that, a connected server stays in kReady.
  void hold(const SeatRequest& request);
  void place_at(const Pose& X_PN);
  /// What SeatRequest::parameters is from now on, for the next time that the scene is loaded; sends nothing.
  void adjust(const link::SetParameters& parameters);
  /// What was last sent with the scene.
  const link::SetParameters& adjusted() const noexcept { return adjusted_; }
  /// Returns the server's refusal of the parameters once; the state machine continues without them.
  std::optional<std::string> take_refusal() { return std::exchange(refusal_, std::nullopt); }

  /// Advances by one step if possible. Errors: timeout, a refusal, a fault.
  Result<State> look();
  State state() const noexcept { return state_; }
  double loading() const noexcept { return view_.status.loading; }  ///< 0..1

  /// Ticks since the forces were on, or since the last call. None from before that, or of a server that came back.
  std::vector<link::NumberedSample> take_samples();
  std::uint64_t ticks_missing() const noexcept { return missing_; }  ///< Among them, so far.
  /// Only in kOn.
  void set_hand(const link::HandTarget& target) { connection_->set_target(target); }
  void stop();
  /// Sends a further command (only in kOn, or when the server is released). Returns its number.
  std::uint32_t send(decltype(link::Command::what) what) { return connection_->send(std::move(what)); }
  std::vector<link::Reply> take_replies();                        ///< Only in kOn.
  const KnownScenes& scenes() const noexcept { return scenes_; }  ///< Of the server that is there now.
  void frame_drawn() { connection_->frame_drawn(); }              ///< See HapticClient.
  /// The newest tick, whatever the state: where the device is while it is not ours.
  std::optional<telemetry::TickSample> newest() const { return connection_->newest(); }

  const link::ClientView& view() const noexcept { return view_; }
  const std::string& endpoint() const noexcept { return endpoint_; }
  int returns() const noexcept { return returns_; }  ///< Number of reconnections.
  int stalls() const noexcept { return stalls_; }    ///< Number of stalls of its loop.
  ServerFigures figures() const;

 private:
  void enter(State state);
  void count_time();
  bool is_stall_to_forgive() const;
  Status wait_for_control();
  Status reset_fault();
  /// The reply to the command that was sent last; none yet: empty.
  Result<bool> is_answered();
  Status check_time(const char* what, const char* advice) const;
  Status connecting();
  Status loading_scene();
  void load_parameters();
  Status placing();
  Status starting();
  void settling();
  bool is_near(const telemetry::TickSample& sample, double most_mm) const;

  std::unique_ptr<ServerConnection> connection_;
  Clock* clock_;
  std::string endpoint_;
  std::chrono::milliseconds patience_;
  std::optional<SeatRequest> request_;
  link::ClientView view_;
  State state_ = State::kConnecting;
  Clock::TimePoint looked_;
  double in_state_s_ = 0.0;  ///< As far as look() was called meanwhile.
  bool was_placed_ = false;  ///< In this state.
  Clock::TimePoint placed_;
  Clock::TimePoint reset_;
  std::uint64_t session_ = 0;  ///< Of the server that holds our scene.
  std::optional<std::uint64_t> last_tick_;
  std::uint64_t missing_ = 0;
  std::uint32_t asked_ = 0;
  double placed_newest_s_ = 0.0;   ///< Time of the newest tick when the hand was placed.
  double started_server_s_ = 0.0;  ///< Server's time when it said that it would start.
  KnownScenes scenes_;
  link::SetParameters adjusted_;
  bool is_adjusting_ = false;  ///< In kLoading: the scene is there, its parameters are asked for.
  std::optional<std::string> refusal_;
  int returns_ = 0, stalls_ = 0;
  double without_control_s_ = 0.0;  ///< Of in_state_s_, when the server first said so; 0: it did not.
};

}  // namespace trocar::attempt
