#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace trocar {
inline namespace core {

/// Files and folders that must not outlive a failure or an interruption. They are removed at the end unless keep() was
/// called, and by end_without_unfinished_outputs(). Thread-safe.
class UnfinishedOutput {
 public:
  explicit UnfinishedOutput(std::vector<std::filesystem::path> paths);
  ~UnfinishedOutput();
  UnfinishedOutput(const UnfinishedOutput&) = delete;
  UnfinishedOutput& operator=(const UnfinishedOutput&) = delete;

  /// The first of the paths is a finished output from here on.
  void keep();
  /// Renames the only path to `target`, which is then a finished output. An interruption comes before or after it.
  std::error_code rename_to(const std::filesystem::path& target);

 private:
  std::vector<std::filesystem::path> paths_;
};

/// Adds a path to the process-wide list of unfinished outputs, or takes it off without touching it.
void register_unfinished_output(const std::filesystem::path& path);
void unregister_unfinished_output(const std::filesystem::path& path);
/// A finished output that nobody asked for, such as a cached patient: an interruption does not name it.
void forget_finished_output(const std::filesystem::path& path);

/// Ends the process with status 1 after removing its unfinished outputs. `say_why(output)` returns the line for
/// standard error; `output` is the last finished one, or empty. Other threads end first, so that none recreates a file.
[[noreturn]] void end_without_unfinished_outputs(std::string (*say_why)(const std::filesystem::path& output));

}  // namespace core
}  // namespace trocar
