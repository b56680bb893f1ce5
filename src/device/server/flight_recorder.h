#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "server/servo.h"

namespace trocar::server {

/// Keeps the last periods and returns them after a fault has latched and some more periods were recorded. Fed by the
/// link thread with the records of the servo, at no cost for the servo.
class FlightRecorder {
 public:
  /// `rate_hz`: of the records. Keeps kBefore_s before the fault and kAfter_s of what came after it.
  explicit FlightRecorder(double rate_hz);
  /// One record; a flight when it is complete.
  std::optional<std::vector<ServoRecord>> add(const ServoRecord& record);

  static constexpr double kBefore_s = 2.0;
  static constexpr double kAfter_s = 0.1;

 private:
  std::size_t before_, after_;
  std::size_t wanted_ = 0;  ///< Records still to come; 0: no fault is being recorded.
  telemetry::GateFault fault_ = telemetry::GateFault::kNone;
  std::deque<ServoRecord> records_;
};

/// What a folder may hold of flight records.
struct FlightQuota {
  std::size_t files = 20;              ///< Range 1 and up.
  std::uintmax_t bytes = 64ULL << 20;  ///< Of all together; a flight at 4 kHz has about 3 MB.
};

/// Removes the oldest flight records, by the time in their names, until the folder is within its quota. `newest` stays.
/// Only regular files named flight-UTC-FAULT.csv are counted and removed. Gives how many were removed.
std::size_t keep_quota(const std::filesystem::path& folder, const std::filesystem::path& newest,
                       const FlightQuota& quota = {});

/// Writes FOLDER/flight-UTC-FAULT.csv, one row per period: the tick's fields that telemetry/tick_fields.h names for it,
/// pose, buttons, wanted and written wrench, actions of the gate. Older records make room for it (keep_quota). Gives
/// its path.
Result<std::filesystem::path> write_flight(const std::filesystem::path& folder, const std::string& utc,
                                           const std::vector<ServoRecord>& flight);

}  // namespace trocar::server
