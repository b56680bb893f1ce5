#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "attempt/live/attempt_loop.h"
#include "attempt/servers/haptic_servers.h"
#include "cases/open_case.h"
#include "core/files/file_system.h"

namespace trocar::attempt {

struct AttemptOptions : AttemptIdentity {
  std::filesystem::path session;  ///< Written here; must not exist. Its folder must.
  /// In the form of trocar-hapticd --device, see DeviceControl.
  std::string device_needle = "virtual:premium";
  std::string device_probe = "virtual:premium";
  double rate_hz = 1000.0;         ///< 250..4000.
  int priority = 80;               ///< Priority of the servers' real-time threads; 0: ordinary scheduling.
  std::string force_model;         ///< Empty: the case's.
  bool is_guided = false;          ///< Hints are given.
  bool has_probe = true;           ///< false: only the needle's server is used.
  std::optional<Pose> X_PN_start;  ///< Empty: 20 mm before the entry on the planned path.
  std::optional<Pose> X_PT_start;  ///< Empty: the case's.
  /// Timeout after which a server is restarted; four times as long if it gets no processor time.
  std::chrono::milliseconds timeout{8000};
  /// Called with the session's folder once a second during recording; tests replace it.
  std::function<std::optional<std::uintmax_t>(const std::filesystem::path&)> free_bytes = find_free_bytes;
};

/// A running attempt on a thread of its own: the window's client of AttemptLoop. Starts the haptic servers. No member
/// blocks on servers or files; any one thread may call them. The destructor ends the attempt without a score and keeps
/// the recording; it waits for the thread and for servers that are not shared (about 10 ms).
class LiveAttempt : private AttemptExchange {
 public:
  /// Starts the attempt; errors are published as kFailed. `servers` that do not fit the options are not used.
  LiveAttempt(std::shared_ptr<const cases::OpenCase> open_case, AttemptOptions options,
              std::shared_ptr<HapticServers> servers = nullptr);
  ~LiveAttempt();
  LiveAttempt(const LiveAttempt&) = delete;
  LiveAttempt& operator=(const LiveAttempt&) = delete;

  const std::filesystem::path& session_path() const noexcept { return options_.session; }
  const AttemptOptions& options() const noexcept { return options_; }

  // See AttemptExchange.
  using AttemptExchange::act;
  using AttemptExchange::clamp;
  using AttemptExchange::finish;
  using AttemptExchange::frame_drawn;
  using AttemptExchange::note_xray;
  using AttemptExchange::perform;
  using AttemptExchange::repeat_phase;
  using AttemptExchange::resume_forces;
  using AttemptExchange::servers;
  using AttemptExchange::set_goal;
  using AttemptExchange::set_parameters;
  using AttemptExchange::states;
  using AttemptExchange::stop_forces;
  using AttemptExchange::take_events;
  using AttemptExchange::take_forces;
  using AttemptExchange::view;
  /// Returns the result once. Its warnings contain the gaps of the session.
  std::optional<Result<RunResult>> take_result();

 private:
  void publish_failure(Error error);
  void run(const std::stop_token& stop, std::shared_ptr<const cases::OpenCase> open_case,
           std::shared_ptr<HapticServers> servers);
  Result<std::shared_ptr<HapticServers>> find_servers(std::shared_ptr<HapticServers> kept) const;

  AttemptOptions options_;
  std::jthread thread_;
};

/// Options of the loop for an attempt of a trainee.
LoopOptions loop_options(const cases::OpenCase& open_case, const AttemptOptions& options);
/// The case of a loop. The loop keeps the open case.
AttemptCase attempt_case(std::shared_ptr<const cases::OpenCase> open_case);
/// Operators of a loop if a trainee leads both tools.
AttemptOperators trainee_operators(const cases::OpenCase& open_case, const AttemptOptions& options);

}  // namespace trocar::attempt
