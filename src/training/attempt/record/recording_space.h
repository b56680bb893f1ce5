#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/result.h"

namespace trocar::attempt {

/// Remaining recording time on a disk. A session takes 11 MB a minute at 1000 ticks a second.
class RecordingSpace {
 public:
  /// `free_bytes`: free space of the file system of `folder`; empty: unknown, no warning.
  RecordingSpace(std::filesystem::path folder, std::optional<std::uintmax_t> free_bytes, double rate_hz = 1000.0);

  /// True if recording must end: the remaining space is needed to close the session with its score.
  bool is_full() const noexcept;
  /// Recording time until the disk is full.
  double left_s() const noexcept;
  /// Error if less than 10 s can be recorded: an attempt cannot begin. It names the folder, the free space and the
  /// remedy.
  Status check_start() const;
  /// Warning before an attempt: less than kAmple_s left. Empty: enough.
  std::string start_warning() const;
  /// Warning during recording: less than kScarce_s left. Empty: enough.
  std::string banner() const;

  /// Space for SQLite's log of at most 1000 pages of 4 KiB, its copy in the session file, and the outcome.
  static constexpr double kClosing_bytes = 9e6;
  static constexpr double kAmple_s = 600.0;   ///< Longer than most attempts. [assumed]
  static constexpr double kScarce_s = 120.0;  ///< Sufficient time to end an attempt without haste. [assumed]

 private:
  std::filesystem::path folder_;
  std::optional<double> free_bytes_;
  double bytes_a_second_;
};

}  // namespace trocar::attempt
