#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/record/run_result.h"
#include "attempt/servers/local_server.h"
#include "cases/open_case.h"
#include "core/clock.h"
#include "core/files/disk_space.h"
#include "tasks/operator.h"

namespace trocar::attempt {

/// Tool held by a hand.
enum class HandTool : std::uint8_t { kNeedle, kProbe };

struct AttemptOptions {
  std::filesystem::path session;    ///< Written here; must not exist. Its folder must.
  std::string trainee = "trainee";  ///< Recorded as the operator's name.
  /// As trocar-hapticd --device takes them. "virtual…" and "mouse" are moved by set_hand(); "gamepad" and "spacemouse"
  /// move themselves and are put to the start; any other is in a real hand and begins where it is.
  std::string device_needle = "virtual:premium";
  std::string device_probe = "virtual:premium";
  double rate_hz = 1000.0;  ///< 250..4000.
  int priority = 80;        ///< Of the servers' real-time threads; 0: ordinary scheduling.
  std::string force_model;  ///< Empty: the case's.
  std::uint64_t seed = 1;
  std::string level;             ///< Of help, recorded: "guided", "assisted", "exam".
  bool is_guided = false;        ///< Hints are given.
  bool waits_for_begin = false;  ///< Recording starts at begin(): a briefing may go before it. Else when all is ready.
  bool has_probe = true;         ///< false: one server alone.
  std::optional<Pose> X_PN_start;  ///< Empty: 20 mm before the entry on the planned path.
  std::optional<Pose> X_PT_start;  ///< Empty: the case's.
  /// Timeout after which a server is restarted; four times as long if it gets no processor time.
  std::chrono::milliseconds patience{8000};
  /// Asked about the session's folder once a second while it is recorded; tests put another disk in its place.
  std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)> free_bytes = find_free_bytes;
  std::shared_ptr<Clock> clock = std::make_shared<SteadyClock>();  ///< Of supervision and recording.
};

/// Whether set_hand() moves a device of that name; else it moves itself, or a person does.
bool is_moved_by_hand_targets(const std::string& device);

/// The haptic servers of a trainer. If they are kept between attempts, they need not reopen the patient. Only one
/// attempt uses them at a time.
class SeatServers {
 public:
  /// Errors: no trocar-hapticd, it cannot be started.
  static Result<std::shared_ptr<SeatServers>> start(const AttemptOptions& options);
  bool fits(const AttemptOptions& options) const;

  std::unique_ptr<LocalServer> needle;
  std::unique_ptr<LocalServer> probe;  ///< Null: none.

 private:
  SeatServers() = default;
};

/// A running attempt, on a thread of its own: starts and supervises the haptic servers, sends hand targets, records
/// every needle tick, and scores at the end. No member blocks on servers or files; any one thread may call them. The
/// destructor ends the attempt without a score and keeps the recording; it waits for the thread and for servers that
/// are not shared (about 10 ms).
class LiveAttempt {
 public:
  /// Starts; what is wrong shows as kFailed. `servers` that do not fit the options are not used.
  LiveAttempt(std::shared_ptr<const cases::OpenCase> open_case, AttemptOptions options,
              std::shared_ptr<SeatServers> servers = nullptr);
  ~LiveAttempt();
  LiveAttempt(const LiveAttempt&) = delete;
  LiveAttempt& operator=(const LiveAttempt&) = delete;

  AttemptView view() const;
  /// Of the recorded session since the last call, thinned to what a plot shows; no peak is lost.
  std::vector<ForcePoint> take_forces();
  std::vector<AttemptEvent> take_events();
  /// Once, in kFinished or kFailed.
  std::optional<Result<RunResult>> take_result();
  const std::filesystem::path& session_path() const noexcept { return options_.session; }
  const AttemptOptions& options() const noexcept { return options_; }
  /// For the next attempt; null before they were started.
  std::shared_ptr<SeatServers> servers() const;

  /// The window has drawn a picture. Once called, the servers are told how old the last one is.
  void frame_drawn();
  /// Target pose and velocity (mm/s of tip or face, rad/s) of a hand. A hand without an update for 50 ms stops; a jump
  /// is slowed down to possible hand motion. While there are no data from the needle (kServerLost), targets are
  /// ignored.
  void set_hand(HandTool tool, const Pose& X_PTool, const Vec3& v_P = Vec3::Zero(), const Vec3& w_P = Vec3::Zero());
  /// Locked: the tool stays in place and ignores set_hand.
  void hold(HandTool tool, bool is_clamped);
  void begin();  ///< See AttemptOptions::waits_for_begin.
  void fire();   ///< The biopsy gun; counts once.
  void stop_forces();
  void resume_forces();
  /// "liver.k=0.5", "force_model=proxy": to the servers while they run; the insertion goes on. Numbers of tissues are
  /// all that differ from the case's table, and replace those of the last call that named any; an empty list: as the
  /// case has them (see SetParameters). What the server says of it is the view's message.
  void set_parameters(std::vector<std::string> settings);
  /// An operator of `training` moves the needle, after the hand has gone to where it begins; the view's is_performing
  /// says how long.
  void perform(std::unique_ptr<tasks::Operator> the_operator);
  /// Ends the attempt and scores it. Without a single tick it fails.
  void finish();

 private:
  struct Impl;
  AttemptOptions options_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::attempt
