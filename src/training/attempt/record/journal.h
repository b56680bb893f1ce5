#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "cases/open_case.h"
#include "core/files/file_system.h"
#include "core/result.h"

namespace trocar::attempt {

/// Record of the running attempts in a file, so that a crash loses no data.
struct JournalEntry {
  cases::CaseChoice choice;
  std::filesystem::path session;  ///< Session file of the running attempt.
};

/// An interrupted attempt that this program holds.
class JournalClaim {
 public:
  const JournalEntry& entry() const noexcept { return entry_; }
  /// Removes the attempt from the journal.
  void forget() && noexcept;

 private:
  friend class Journal;
  JournalClaim(JournalEntry entry, std::filesystem::path file, FileLock lock)
      : entry_(std::move(entry)), file_(std::move(file)), lock_(std::move(lock)) {}

  JournalEntry entry_;
  std::filesystem::path file_;
  FileLock lock_;
};

/// Running attempts in a state folder, of all trainers that use it. Each attempt has a file `attempts`/NAME.json; NAME
/// is that of its session. The file is written before the attempt begins and removed after a normal end. The trainer
/// holds a lock on NAME.lock in the same folder as long as it runs; an attempt with a free lock was interrupted.
class Journal {
 public:
  explicit Journal(const std::filesystem::path& folder) : folder_(folder / "attempts") {}

  /// Adds an attempt and ends the previous one. Errors: the files cannot be written or locked.
  Status begin(const JournalEntry& state);
  /// Call after a normal end of the attempt.
  void clear() noexcept;
  /// The newest interrupted attempt whose session still exists; attempts of running trainers are excluded. Unreadable
  /// files are ignored.
  std::optional<JournalEntry> find_cut_off() const;
  /// Takes an interrupted attempt, to open it: while the claim lives, no other trainer finds it. It stays in the
  /// journal until forget(), so that a program that is killed meanwhile offers it again. Empty: it no longer exists, or
  /// another trainer has it.
  std::optional<JournalClaim> claim(const JournalEntry& state) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;  ///< File of the current attempt.
  std::optional<FileLock> lock_;
};

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
