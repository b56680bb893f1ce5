#pragma once

#include <filesystem>
#include <memory>
#include <system_error>

#include "core/files/unfinished_output.h"
#include "core/result.h"

namespace trocar {
inline namespace core {

/// Hidden path beside `target` for an output that process `process` writes: ".NAME.PROCESS.part". Same ending as the
/// target, which is absolute and does not end with a slash.
std::filesystem::path part_path(const std::filesystem::path& target, int process);

/// A new empty folder for an UnfinishedOutput. It is locked (flock) as long as this object exists; the system releases
/// the lock of a process that was killed, so that others can tell an abandoned folder from one in use. File systems
/// without such locks get a folder without a lock.
class PartFolder {
 public:
  /// Removes an abandoned folder of this name first. Errors: the folder is in use or cannot be created.
  static Result<PartFolder> create(const std::filesystem::path& path);
  PartFolder(PartFolder&& other) noexcept;
  PartFolder& operator=(PartFolder&&) = delete;
  /// Removes the folder unless it was renamed.
  ~PartFolder();

  /// As UnfinishedOutput::rename_to.
  std::error_code rename_to(const std::filesystem::path& target) { return unfinished_->rename_to(target); }

 private:
  PartFolder(std::unique_ptr<UnfinishedOutput> unfinished, int descriptor) noexcept;
  std::unique_ptr<UnfinishedOutput> unfinished_;
  int descriptor_ = -1;  ///< -1: not locked.
};

/// Removes the folders of part_path() that killed processes of this user left behind for `target`. Folders in use, and
/// those on a file system without locks, stay.
void remove_abandoned_parts(const std::filesystem::path& target);

}  // namespace core
}  // namespace trocar
