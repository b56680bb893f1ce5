#include "core/unfinished_output.h"

#include <unistd.h>

#include <algorithm>
#include <mutex>

namespace trocar {
namespace fs = std::filesystem;
namespace {

/// A path and the process that makes it: a forked child does not remove what its parent is making.
struct Entry {
  fs::path path;
  pid_t process;
  bool operator==(const Entry&) const = default;
};

/// Process-wide, since a signal belongs to the process. Never destroyed: threads may outlive static objects.
struct Registry {
  std::mutex mutex;
  std::vector<Entry> entries;
};
Registry& registry() {
  static auto* const kRegistry = new Registry;
  return *kRegistry;
}

fs::path absolute_path(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? path : absolute;
}

}  // namespace

void register_unfinished_output(const fs::path& path) {
  const std::lock_guard lock(registry().mutex);
  registry().entries.push_back({absolute_path(path), ::getpid()});
}

void unregister_unfinished_output(const fs::path& path) {
  const std::lock_guard lock(registry().mutex);
  auto& entries = registry().entries;
  const auto found = std::find(entries.begin(), entries.end(), Entry{absolute_path(path), ::getpid()});
  if (found != entries.end()) entries.erase(found);
}

void remove_unfinished_outputs() {
  const std::lock_guard lock(registry().mutex);
  std::error_code ignored;
  for (const Entry& entry : registry().entries)
    if (entry.process == ::getpid()) fs::remove_all(entry.path, ignored);
}

UnfinishedOutput::UnfinishedOutput(std::vector<fs::path> paths) : paths_(std::move(paths)) {
  for (const fs::path& path : paths_) register_unfinished_output(path);
}

UnfinishedOutput::~UnfinishedOutput() {
  std::error_code ignored;
  for (const fs::path& path : paths_) {
    fs::remove_all(path, ignored);
    unregister_unfinished_output(path);
  }
}

void UnfinishedOutput::keep() {
  for (const fs::path& path : paths_) unregister_unfinished_output(path);
  paths_.clear();
}

}  // namespace trocar
