#pragma once

#include <filesystem>
#include <optional>

#include "cases/open_case.h"
#include "core/files/file_lock.h"
#include "core/result.h"

namespace trocar::attempt {

/// Record of the running attempts in a file, so that a crash loses no data.
struct JournalEntry {
  cases::CaseChoice choice;
  std::filesystem::path session;  ///< Session file of the running attempt.
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
  /// Removes an interrupted attempt from the journal. False: it no longer exists, or another trainer has it.
  bool forget(const JournalEntry& state) const noexcept;

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;  ///< File of the current attempt.
  std::optional<FileLock> lock_;
};

}  // namespace trocar::attempt
