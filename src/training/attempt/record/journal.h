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
  std::filesystem::path session;  ///< Of the attempt under way.
};

/// The attempts under way in a state folder, of all trainers that use it. An attempt has a file `attempts`/NAME.json,
/// NAME being its session's: written before the attempt begins, taken away when it has ended in order. NAME.lock beside
/// it is locked as long as its trainer lives; an attempt whose lock is free was cut off.
class Journal {
 public:
  explicit Journal(const std::filesystem::path& folder) : folder_(folder / "attempts") {}

  /// Ends the one that was begun before. Errors: the files cannot be written or locked.
  Status begin(const JournalEntry& state);
  /// The attempt begun has ended in order.
  void clear() noexcept;
  /// The newest interrupted attempt whose session still exists; attempts of running trainers are excluded. Unreadable
  /// files are ignored.
  std::optional<JournalEntry> find_cut_off() const;
  /// Takes a cut-off attempt out of the journal. False: it is no longer there, or another trainer has it.
  bool forget(const JournalEntry& state) const noexcept;

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;  ///< Of the attempt begun.
  std::optional<FileLock> lock_;
};

}  // namespace trocar::attempt
