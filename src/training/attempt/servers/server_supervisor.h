#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/record/known_scenes.h"
#include "attempt/record/score_session.h"
#include "attempt/servers/server_host.h"
#include "core/clock.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

enum class ServerState : std::uint8_t {
  kConnecting,   ///< No session with control and a status yet, or a fault is being reset.
  kIdle,         ///< Connected; prepare() was not called.
  kLoading,      ///< The server loads the scene.
  kAdjusting,    ///< The scene gets its changed parameters.
  kPlacing,      ///< The device is put to the start pose.
  kStarting,     ///< The forces are being switched on.
  kSettling,     ///< The tool comes to rest under forces.
  kOn,           ///< The attempt moves the tool.
  kDeviceLost,   ///< The server responds, its device is disconnected: the supervisor requests the server to open it
                 ///< again.
  kRestartDue,   ///< Announced; the next poll() starts the process, which blocks, after the banner was displayed.
  kStopped,      ///< The user stopped the forces, and the server has to be prepared again; idle until resume_forces().
  kNeedsResume,  ///< The forces of a device in a person's hand were switched off by a fault; idle until
                 ///< resume_forces().
  kFailed,       ///< Given up, see failure(); resume_forces() tries again.
};
const char* to_string(ServerState state) noexcept;

/// Reaction of a supervisor to a failure of its server.
enum class Recovery : std::uint8_t {
  kReturnsOnly,  ///< Prepares a server again after a reconnection or a stall of its loop; all other cases are failures
                 ///< (command line).
  kAll,          ///< Also restarts processes, resets faults, reopens devices and waits for slow servers (window).
};

struct SupervisionOptions {
  Recovery recovery = Recovery::kAll;
  /// Timeout without messages; also of placing, switching on, and a reset.
  std::chrono::milliseconds timeout{8000};
  std::string client_name = "trocar";
  bool has_window = false;  ///< See link::ClientOptions.
};

/// Scene and start pose of a server's preparation.
struct PreparationRequest {
  link::LoadScene scene;
  link::HandTarget place;  ///< Start pose; at rest, and rigid until the forces are on.
};

/// Brings one haptic server to the state in which its forces are on, and back to it after an interruption. It is the
/// only state machine of supervision (README.md). Only restarting a process and end() block. Call poll() every 1 to 2
/// ms; time without calls does not count as a timeout. The supervisor waits for a slow server while its process is
/// stopped or waits for a processor, up to four timeouts. A device in a person's hand gets no forces again after a
/// fault before resume_forces().
class ServerSupervisor {
 public:
  /// Connects. Host and clock must outlive it.
  ServerSupervisor(ServerHost& host, SupervisionOptions options, Clock& clock);

  /// Sets scene and start pose. Before this call, a connected server stays in kIdle.
  void prepare(const PreparationRequest& request);
  /// Sets where the tool is placed when the server is prepared again.
  void place_at(const telemetry::NeedlePlace& needle);
  void place_at(const Pose& X_PTool) { place_at(telemetry::NeedlePlace{X_PTool, 0.0}); }
  /// true: the preparation ends before the forces are switched on, however long, until false is set. While another
  /// server loads its scene, this one would get no processor time for its loop.
  void hold_start(bool is_held) noexcept { is_start_held_ = is_held; }
  /// Performs one step. Returns the text of a note; empty: none.
  std::string poll();

  ServerState state() const noexcept { return state_; }
  /// Before the scene is loaded, or being restarted.
  bool is_loading() const noexcept;
  /// kOn, connected, and a tick was taken within the last 250 ms: otherwise the present pose of the tool is unknown.
  bool is_fresh() const noexcept;
  const Error& failure() const noexcept { return failure_; }  ///< In kFailed.
  const std::string& banner() const noexcept { return banner_; }
  /// Returns, once after the forces are on again, a sentence with the cause of the interruption. Empty: nothing new.
  std::string take_recovery() { return std::exchange(recovery_, {}); }
  /// Replies to set_parameters().
  std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }
  double loading() const noexcept { return client_.status.loading; }  ///< 0..1
  std::string activity() const;                                       ///< For a progress line.

  /// Ticks since the forces were on, or since the last call. Only in kOn; without ticks of a server that has
  /// reconnected.
  std::vector<link::NumberedSample> take_samples();
  const KnownScenes& scenes() const noexcept { return scenes_; }  ///< Scenes of the present server process.
  int activations() const noexcept { return activations_; }       ///< Number of times that kOn was reached.
  /// Ignored unless is_fresh().
  void set_target(const link::HandTarget& target);
  /// Sent now in kOn, and again whenever the server is prepared. The times of its motion are those of this program's
  /// steady clock.
  void set_parameters(const link::SetParameters& message);
  void stop_forces();
  void resume_forces();
  void frame_drawn();
  void end();  ///< Forces off; waits for the reply, 500 ms at most.

  const ServerHost& host() const noexcept { return *host_; }
  const std::string& tool() const noexcept;  ///< "needle", "probe"; empty: not known yet.
  const link::ClientView& client() const noexcept { return client_; }
  ServerView view() const;
  ServerFigures figures() const;

 private:
  // server_supervisor.cpp: processes, faults, recovery, commands.
  void connect();
  bool is_waiting() const noexcept;
  std::string poll_connection();
  std::string note_end(const Error& why);
  std::string note_interruption(const char* what);
  std::string give_up(Error why);
  std::string fail_with(const Error& why);
  std::string await_resume(const Error& why);
  std::string bring_back(const std::string& what, bool is_new_process);
  std::string restart();
  std::string poll_lost_device();
  void poll_on();
  void take_on_replies();
  bool has_person() const noexcept { return control_ == DeviceControl::kPersonsHand; }
  bool is_device_lost() const;
  bool is_slow() const;
  /// The forces were not yet switched on, and not for long: a stall says nothing but that the machine is busy.
  bool is_early() const;
  /// A stall whose fault may be reset without the user's consent.
  bool is_forgivable_stall() const;

  // server_preparation.cpp: from kConnecting to kOn.
  Status check_silence() const;
  Status step_preparation();
  Status step_connecting();
  Status wait_for_control();
  Status reset_fault();
  Status step_loading();
  std::uint32_t send(link::LoadScene message);
  std::uint32_t send(link::SetParameters message);
  void adjust();
  void step_adjusting();
  Status step_placing();
  void start_forces(const link::HandTarget* place);
  Status step_starting();
  void step_settling();
  void become_on();
  void enter(ServerState state);
  void count_time();
  bool has_timed_out() const noexcept;
  Status check_time(const char* what, const char* advice) const;
  /// True if the reply to the last command has come. Error: it was refused.
  Result<bool> is_answered();
  std::vector<link::Reply> take_replies();
  bool is_near(const telemetry::TickSample& sample, double most_mm) const;

  ServerHost* host_;
  SupervisionOptions options_;
  Clock* clock_;
  DeviceControl control_;
  std::unique_ptr<ServerConnection> connection_;  ///< Null: the connection failed.
  std::optional<PreparationRequest> request_;
  link::ClientView client_;  ///< At the last poll.
  ServerState state_ = ServerState::kConnecting;
  Error failure_;
  std::string banner_, recovery_;
  std::string interrupted_by_;  ///< Cause of the interruption since the forces were last on; empty: none.
  bool is_stopped_ = false;     ///< Stopped by the user.
  bool is_start_held_ = false;  ///< See hold_start.
  bool was_heard_ = false;      ///< The server has sent a welcome at least once.

  // Timers.
  Clock::TimePoint polled_;
  double in_state_s_ = 0.0;         ///< Without the time in which poll() was not called.
  double without_control_s_ = 0.0;  ///< in_state_s_ when control was first refused; 0: it was not.
  Clock::TimePoint placed_, reset_;
  Clock::TimePoint requested_;  ///< Time of prepare(), or of the last resume_forces().
  Clock::TimePoint ticked_;     ///< Time at which a tick was last taken.
  Clock::TimePoint held_up_;    ///< Last time at which the server was connected, or its process had no processor.
  std::deque<Clock::TimePoint> returns_;  ///< Times of the recoveries within the last minute.

  // State of the present connection.
  std::uint64_t session_ = 0;  ///< Session of the server that has our scene.
  std::optional<std::uint64_t> last_tick_;
  std::uint32_t asked_ = 0;        ///< Number of the last command of the preparation.
  bool was_placed_ = false;        ///< The tool was placed, in kPlacing.
  double placed_newest_s_ = 0.0;   ///< Server's time of the newest tick when the tool was put to its pose.
  double started_server_s_ = 0.0;  ///< Server's time when it accepted kStart; 0: not yet.
  KnownScenes scenes_;
  struct Reopening {
    std::optional<std::uint32_t> asked;  ///< Number of a command without a reply yet.
    Clock::TimePoint refused;
  } reopening_;

  // Parameters.
  ParameterMemory memory_;
  link::SetParameters adjusted_;                         ///< Sent with the scene.
  std::map<std::uint32_t, ParameterMemory> unanswered_;  ///< Memory before a message without a reply yet.
  std::vector<std::string> messages_;

  // Counters.
  static constexpr int kMostStallsOfStart = 5;  ///< [assumed]
  std::uint64_t missing_ = 0;
  int restarts_ = 0, activations_ = 0;
  int reconnects_ = 0, stalls_ = 0;
  int stalls_left_ = 0;  ///< That may still interrupt the start of a person's device; 0 when its forces were on.
};

}  // namespace trocar::attempt
