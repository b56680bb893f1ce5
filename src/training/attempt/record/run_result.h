#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "realtime/loop_statistics.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// A layer that gave way.
struct PunctureRecord {
  std::string layer;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double peak_n = 0.0;  ///< Pre-puncture force when it gave way.
};

/// How a haptic server did while an attempt went through it.
struct ServerFigures {
  std::string tool;  ///< "needle", "probe"
  std::string endpoint;
  std::string server;          ///< "trocar-hapticd 0.1.0"
  std::string device;          ///< "virtual:premium"
  std::string grant;           ///< What the system granted it, in words.
  realtime::LoopSummary loop;  ///< Since the server was started.
  std::uint64_t ticks_received = 0;
  std::uint64_t ticks_missing = 0;  ///< Gaps in their numbers.
  int returns = 0;                  ///< How often it was lost and found again.
};

struct RunResult {
  tasks::Outcome outcome;
  std::vector<PunctureRecord> punctures;
  std::string force_model;  ///< At the first tick.
  std::size_t ticks = 0;
  std::string ticks_hash;    ///< Of all of them, as in the session file (storage::Session); empty: it was not finished.
  double simulated_s = 0.0;  ///< Of the last tick; through live servers their time, gaps included.
  double active_s = 0.0;     ///< Of it without interruptions: the trainee could act.
  std::uint64_t ticks_missing = 0;     ///< Of the session: ticks that a live server made and nobody received.
  double paused_s = 0.0;               ///< Of it without a server; through live servers only, and
  double unseen_s = 0.0;               ///< of it without an operator, because this program got no processor.
  std::vector<ServerFigures> servers;  ///< Of an attempt through live servers: the needle's first.
  std::vector<std::string> warnings;
  std::string cut_short;  ///< Why the attempt was ended before the operator ended it; empty: it was not.
  /// All that was recorded, where the file could not take it to the end: the file lacks the last of it and the score.
  std::optional<storage::Session> unsaved;
};

/// What went through the skin, in order.
std::vector<PunctureRecord> find_punctures(const storage::SessionInfo& info,
                                           const std::vector<telemetry::TickSample>& samples);

}  // namespace trocar::attempt
