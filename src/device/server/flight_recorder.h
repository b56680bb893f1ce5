#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "server/servo.h"

namespace trocar::server {

/// Keeps the records of the last periods. After a fault has latched, it records kAfter_s more and returns them. The
/// link thread adds the records, so that the servo thread spends no time on them.
class FlightRecorder {
 public:
  /// `rate_hz`: rate of the records. Keeps kBefore_s before the fault and kAfter_s after it.
  explicit FlightRecorder(double rate_hz);
  /// Adds one record. Returns a flight record when it is complete.
  std::optional<std::vector<ServoRecord>> add(const ServoRecord& record);
  /// The server ends: returns the flight record of a fault less than kAfter_s ago, with the records so far.
  std::optional<std::vector<ServoRecord>> finish();

  static constexpr double kBefore_s = 2.0;
  static constexpr double kAfter_s = 0.1;

 private:
  std::size_t before_, after_;
  std::size_t wanted_ = 0;  ///< Records still to come; 0: no fault is being recorded.
  telemetry::GateFault fault_ = telemetry::GateFault::kNone;
  std::deque<ServoRecord> records_;
};

/// Limits of the flight records in a folder.
struct FlightQuota {
  std::size_t files = 20;              ///< Range 1 and up.
  std::uintmax_t bytes = 64ULL << 20;  ///< Sum of all files; one record at 4 kHz has about 3 MB.
};

/// Removes the oldest flight records, by the time in their names, until the folder is within its quota. `newest` is
/// kept. Only regular files named flight-UTC-FAULT.csv are counted and removed. Returns the number of removed files.
std::size_t keep_quota(const std::filesystem::path& folder, const std::filesystem::path& newest,
                       const FlightQuota& quota = {});

/// Checks at the start of a server that flight records can be written: creates the folder if it is missing, writes a
/// small file and looks for room for one record. Errors: not possible, with the reason.
Status check_flight_folder(const std::filesystem::path& folder);

/// A time for the name of a flight record, to the millisecond: "20260101T000000.123Z".
std::string flight_time(std::chrono::system_clock::time_point time);

/// Writes FOLDER/flight-UTC-FAULT.csv, or flight-UTC-FAULT-2.csv and so on if there is such a file: no file is
/// overwritten, also if several servers write to the folder. One row per period: the tick fields that
/// telemetry/tick_fields.h selects for it, pose, buttons, wanted and written wrench, actions of the gate. Removes older
/// records beyond the quota (keep_quota). Returns the path.
Result<std::filesystem::path> write_flight(const std::filesystem::path& folder, const std::string& utc,
                                           const std::vector<ServoRecord>& flight);

}  // namespace trocar::server
