#pragma once

#include <filesystem>
#include <vector>

namespace trocar {

/// Files and folders that must not outlive a failure or an interruption. They are removed at the end unless keep() was
/// called, and by remove_unfinished_outputs(). Thread-safe.
class UnfinishedOutput {
 public:
  explicit UnfinishedOutput(std::vector<std::filesystem::path> paths);
  ~UnfinishedOutput();
  UnfinishedOutput(const UnfinishedOutput&) = delete;
  UnfinishedOutput& operator=(const UnfinishedOutput&) = delete;

  void keep();

 private:
  std::vector<std::filesystem::path> paths_;
};

/// Adds a path to the process-wide list of unfinished outputs, or takes it off without touching it.
void register_unfinished_output(const std::filesystem::path& path);
void unregister_unfinished_output(const std::filesystem::path& path);
/// Removes all unfinished outputs of the process: an interrupted program calls it before it ends.
void remove_unfinished_outputs();

}  // namespace trocar
