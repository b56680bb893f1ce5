#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/case/open_case.h"
#include "attempt/live/attempt_view.h"
#include "attempt/record/run_result.h"
#include "attempt/servers/own_server.h"
#include "core/files/disk_space.h"
#include "link/messages.h"
#include "tasks/operator.h"

namespace trocar::attempt {

/// Which of the two tools a hand holds.
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
  /// How long a server may be silent before it is started again; one that has no processor, four times as long.
  std::chrono::milliseconds patience{8000};
  /// Asked about the session's folder once a second while it is recorded; tests put another disk in its place.
  std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)> free_bytes = find_free_bytes;
};

/// Whether set_hand() moves a device of that name; else it moves itself, or a person does.
bool is_moved_by_hand_targets(const std::string& device);

/// The haptic servers of a seat. Kept from one attempt to the next they need not open the patient again. At most one
/// attempt uses them at a time.
class SeatServers {
 public:
  /// Errors: no trocar-hapticd, it cannot be started.
  static Result<std::shared_ptr<SeatServers>> start(const AttemptOptions& options);
  bool fits(const AttemptOptions& options) const;

  OwnServer needle;
  std::optional<OwnServer> probe;

 private:
  explicit SeatServers(OwnServer of_needle) : needle(std::move(of_needle)) {}
};

/// An attempt while it is performed, on a thread of its own: it starts the haptic servers and looks after them, sends
/// them the hands, records every tick of the needle, and scores at the end. No member waits for servers or files; all
/// may be called from any one thread. The destructor ends the attempt without a score: what was recorded stays; it
/// waits for the thread and for servers that nobody else holds (some 10 ms).
class LiveAttempt {
 public:
  /// Starts; what is wrong shows as kFailed. `servers` that do not fit the options are not used.
  LiveAttempt(std::shared_ptr<const OpenCase> open_case, AttemptOptions options,
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
  /// Where the hand wants the tool, and how fast it moves there (mm/s of the tip or face, rad/s). A hand that is not
  /// told anything for 50 ms stands still; one that jumps is slowed down to what a hand does. While there is no news of
  /// the needle (kServerLost) its hand is not heard: it is where it was when there is.
  void set_hand(HandTool tool, const Pose& X_PTool, const Vec3& v_P = Vec3::Zero(), const Vec3& w_P = Vec3::Zero());
  /// Clamped: the tool stays where its hand is, whatever set_hand says.
  void hold(HandTool tool, bool is_clamped);
  void begin();  ///< See AttemptOptions::waits_for_begin.
  void fire();   ///< The biopsy gun; counts once.
  void stop_forces();
  void resume_forces();
  /// To the servers while they run; the insertion goes on. The loaded table is the case's. The server's answer is the
  /// view's message.
  void set_parameters(link::SetParameters parameters);
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
