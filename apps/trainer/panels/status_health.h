#pragma once

#include <QString>
#include <cstdint>
#include <optional>
#include <vector>

#include "ui_kit/frame_count.h"

namespace trocar::trainer {

/// Figures of one haptic server in the status bar.
struct ServerLine {
  QString tool;  ///< "Needle"
  bool is_connected = false;
  bool waits_for_resume = false;  ///< Not restarted before the user resumes the forces.
  double rate_hz = 0.0;
  double served = 1.0;  ///< Share of periods that were served in time.
  double lateness_p99_us = 0.0;
  std::uint64_t ticks_missing = 0;
  QString fault;  ///< Empty: none.
  QString grant;  ///< Granted real-time privileges, as text.
  bool is_real_time = false;

  bool operator==(const ServerLine&) const = default;
};

/// State of an attempt's forces and pictures, the best first. The worst cause decides.
enum class Health : std::uint8_t {
  kOff,          ///< No attempt is running.
  kStarting,     ///< The servers of the attempt are not all connected yet.
  kGood,         ///< Forces and pictures are as they should be.
  kStopped,      ///< The trainee stopped the forces.
  kSlow,         ///< The attempt continues, but forces or pictures are late.
  kInterrupted,  ///< A server is gone, or its safety gate has switched its forces off.
};

struct HealthReport {
  Health health = Health::kOff;
  QString words;   ///< One or two words: "Slow forces".
  QString reason;  ///< One sentence; empty for kGood.

  bool operator==(const HealthReport&) const = default;
};

/// From here on forces or pictures are slow.
struct HealthLimits {
  double least_served = 0.98;            ///< Share of periods served in time. [assumed]
  double most_lateness_p99_us = 2000.0;  ///< Two periods at 1 kHz. [assumed]
  double least_frames_per_s = 20.0;      ///< [assumed]
  double slowest_frame_ms = 250.0;       ///< A stop that everybody sees. [assumed]
};

/// All that the state depends on.
struct HealthInput {
  std::vector<ServerLine> servers;
  std::optional<FrameFigures> frames;  ///< Empty: not measured yet.
  bool is_attempt = false;
  bool has_started = false;  ///< All servers of the attempt have been connected once.
  bool are_forces_stopped = false;

  bool operator==(const HealthInput&) const = default;
};

HealthReport assess_health(const HealthInput& input, const HealthLimits& limits = {});

/// All figures as an HTML table: a column for each server, and the window's.
QString health_details(const HealthInput& input);

}  // namespace trocar::trainer
