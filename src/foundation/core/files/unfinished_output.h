#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

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
}  // namespace trocar
