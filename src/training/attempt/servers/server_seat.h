#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/record/known_scenes.h"
#include "attempt/record/run_result.h"
#include "core/progress.h"
#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// What a server is to hold, and where the hand begins: at rest, and rigid until the forces are on.
struct SeatRequest {
  link::LoadScene scene;
  link::HandTarget place;
  /// A person's hand holds the device: it is not put anywhere, the forces come on where it is.
  bool is_in_real_hand = false;
  bool resets_fault = false;  ///< A fault that the gate has latched before we came is forgotten.
  /// What differs from the scene's numbers; in force before the forces come on. Nothing in it: not sent.
  link::SetParameters parameters = {};
};

/// One haptic server as an attempt sees it. It connects, has the scene loaded, puts the hand in its place, turns the
/// forces on; from then on the attempt moves the hand. A server that went away and came back goes through all of it
/// again, and so does one whose loop stood still for want of a processor: its fault is reset, unless a person's hand
/// holds the device. Nothing here waits: look() is called every millisecond or so, and time in which it was not called
/// is nobody's delay.
class ServerSeat {
 public:
  enum class State { kConnecting, kReady, kLoading, kPlacing, kStarting, kSettling, kOn };

  static Result<ServerSeat> connect(const link::ClientOptions& options, std::chrono::milliseconds patience);

  /// What to hold from now on; until then a connected server stays in kReady. Where the hand begins may be told anew.
  void hold(const SeatRequest& request);
  void place_at(const Pose& X_PN);
  /// What SeatRequest::parameters is from now on, for the next time that the scene is loaded; sends nothing.
  void adjust(const link::SetParameters& parameters);
  /// What was last sent with the scene.
  const link::SetParameters& adjusted() const noexcept { return adjusted_; }
  /// What the server said where it refused them: the seat goes on without. Once.
  std::optional<std::string> take_refusal() { return std::exchange(refusal_, std::nullopt); }

  /// Goes one step further where it can. Errors: silent for longer than the patience, a refusal, a fault.
  Result<State> look();
  State state() const noexcept { return state_; }
  double loading() const noexcept { return view_.status.loading; }  ///< 0..1

  /// Ticks since the forces were on, or since the last call. None from before that, or of a server that came back.
  std::vector<link::NumberedSample> take_samples();
  std::uint64_t ticks_missing() const noexcept { return missing_; }  ///< Among them, so far.
  /// Only in kOn.
  void set_hand(const link::HandTarget& target) { client_.set_hand(target); }
  void stop();
  /// Only in kOn, and when a seat is given up: a command beside those of the seat itself. Gives its number.
  std::uint32_t send(decltype(link::Command::what) what) { return client_.send(std::move(what)); }
  std::vector<link::Reply> take_replies();                        ///< Only in kOn.
  const KnownScenes& scenes() const noexcept { return scenes_; }  ///< Of the server that is there now.
  void frame_drawn() { client_.frame_drawn(); }                   ///< See HapticClient.
  /// The newest tick, whatever the state: where the device is while it is not ours.
  std::optional<telemetry::TickSample> newest() const { return client_.newest(); }

  const link::ClientView& view() const noexcept { return view_; }
  const std::string& endpoint() const noexcept { return endpoint_; }
  int returns() const noexcept { return returns_; }  ///< Of a server that went away,
  int stalls() const noexcept { return stalls_; }    ///< or that had stood still.
  ServerFigures figures() const;

 private:
  using Clock = std::chrono::steady_clock;

  ServerSeat(link::HapticClient client, std::string endpoint, std::chrono::milliseconds patience);
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

  link::HapticClient client_;
  std::string endpoint_;
  std::chrono::milliseconds patience_;
  std::optional<SeatRequest> request_;
  link::ClientView view_;
  State state_ = State::kConnecting;
  Clock::time_point looked_;
  double in_state_s_ = 0.0;  ///< As far as look() was called meanwhile.
  bool was_placed_ = false;  ///< In this state.
  Clock::time_point placed_;
  Clock::time_point reset_;
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
