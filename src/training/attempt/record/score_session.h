#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cases/prepare_case.h"
#include "core/progress.h"
#include "realtime/loop_statistics.h"
#include "scoring/score.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Scores a recorded attempt of a case, with every metric of it. Without an image plane in its description, what needs
/// one is not judged.
scoring::Outcome score_session(const cases::Case& the_case, const storage::Session& session,
                               const Progress& progress = {});

/// A punctured layer.
struct PunctureRecord {
  std::string layer;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double peak_n = 0.0;  ///< Pre-puncture force at the puncture.
};

/// Figures of a haptic server during an attempt.
struct ServerFigures {
  std::string tool;  ///< "needle", "probe"
  std::string endpoint;
  std::string server;          ///< "trocar-hapticd 0.1.0"
  std::string device;          ///< "virtual:premium"
  std::string grant;           ///< Description of the real-time scheduling that the system granted.
  realtime::LoopSummary loop;  ///< Since the server was started.
  std::uint64_t ticks_received = 0;
  std::uint64_t ticks_missing = 0;  ///< Gaps in the tick numbers.
  int returns = 0;                  ///< Number of recoveries after a loss.
};

struct RunResult {
  scoring::Outcome outcome;
  std::vector<PunctureRecord> punctures;
  std::string force_model;  ///< Force model at the first tick.
  std::size_t ticks = 0;
  std::string ticks_hash;  ///< Hash of all ticks, as in the session file (storage::Session); empty: the session was not
                           ///< finished.
  double simulated_s = 0.0;         ///< Time of the last tick; with live servers their time, gaps included.
  double active_s = 0.0;            ///< Part of simulated_s without interruptions, in which the trainee could act.
  std::uint64_t ticks_missing = 0;  ///< Ticks of the session that a live server made and this program did not receive.
  double paused_s = 0.0;            ///< Part of simulated_s without a server; live servers only.
  /// Part of simulated_s without an operator because this program got no processor; live servers only.
  double unseen_s = 0.0;
  std::vector<ServerFigures> servers;  ///< Live servers only; the needle's first.
  std::vector<std::string> warnings;
  std::string cut_short;  ///< Reason why the attempt ended before the operator ended it; empty: it did not.
  /// All recorded data, if the file could not be written completely: the file lacks the last part and the score.
  std::optional<storage::Session> unsaved;
};

/// Punctured layers, in order.
std::vector<PunctureRecord> find_punctures(const storage::SessionInfo& info,
                                           const std::vector<telemetry::TickSample>& samples);

}  // namespace trocar::attempt
