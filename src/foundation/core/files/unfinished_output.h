#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Files and folders that must not outlive a failure or an interruption. The destructor removes them unless keep() was
/// called; end_without_unfinished_outputs() removes them too. Thread-safe.
class UnfinishedOutput {
 public:
  explicit UnfinishedOutput(std::vector<std::filesystem::path> paths);
  ~UnfinishedOutput();
  UnfinishedOutput(const UnfinishedOutput&) = delete;
  UnfinishedOutput& operator=(const UnfinishedOutput&) = delete;

  /// Marks the first path as a finished output.
  void keep();
  /// Renames the only path to `target`, which is then a finished output. An interruption occurs either before or after
  /// the rename.
  std::error_code rename_to(const std::filesystem::path& target);

 private:
  std::vector<std::filesystem::path> paths_;
};

/// Adds a path to the process-wide list of unfinished outputs, or removes it from the list without changing the file.
void register_unfinished_output(const std::filesystem::path& path);
void unregister_unfinished_output(const std::filesystem::path& path);
/// Removes a finished output that the user did not request, such as a cached patient, from the interruption message.
void forget_finished_output(const std::filesystem::path& path);

/// Ends the process with status 1 after removing its unfinished outputs. `say_why(output)` returns the line for
/// standard error; `output` is the last finished one, or empty. Other threads end first, so that none recreates a file.
[[noreturn]] void end_without_unfinished_outputs(std::string (*say_why)(const std::filesystem::path& output));

}  // namespace core
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
