#include "core/files/unfinished_output.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;
namespace {

/// A path and its process: a forked child does not remove the files of its parent.
struct Entry {
  fs::path path;
  pid_t process;
  bool operator==(const Entry&) const = default;
};

/// Process-wide, since a signal belongs to the process. Never destroyed: threads may outlive static objects.
struct Registry {
  std::mutex mutex;
  std::vector<Entry> entries;
  std::vector<Entry> finished;
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

void take_off(std::vector<Entry>& entries, const fs::path& path) {
  const auto found = std::find(entries.begin(), entries.end(), Entry{absolute_path(path), ::getpid()});
  if (found != entries.end()) entries.erase(found);
}

/// The last finished output outside all unfinished ones; empty: none.
fs::path last_finished(const Registry& list) {
  for (auto output = list.finished.rbegin(); output != list.finished.rend(); ++output) {
    const auto holds = [&](const Entry& entry) {
      return entry.process == ::getpid() && !output->path.lexically_relative(entry.path).native().starts_with("..");
    };
    if (output->process == ::getpid() && std::none_of(list.entries.begin(), list.entries.end(), holds))
      return output->path;
  }
  return {};
}

}  // namespace

void register_unfinished_output(const fs::path& path) {
  const std::lock_guard lock(registry().mutex);
  registry().entries.push_back({absolute_path(path), ::getpid()});
}

void unregister_unfinished_output(const fs::path& path) {
  const std::lock_guard lock(registry().mutex);
  take_off(registry().entries, path);
}

void forget_finished_output(const fs::path& path) {
  const std::lock_guard lock(registry().mutex);
  take_off(registry().finished, path);
}

void end_without_unfinished_outputs(std::string (*say_why)(const fs::path& output)) {
  registry().mutex.lock();  // for ever: no output is finished from here on
  const std::string line = say_why(last_finished(registry()));
  // A shell replaces this program: this ends all threads that could recreate a removed folder.
  constexpr const char* kScript = R"(line=$1; shift; rm -rf -- "$@"; printf '%s\n' "$line" >&2; exit 1)";
  std::vector<std::string> words = {"sh", "-c", kScript, "sh", line};
  for (const Entry& entry : registry().entries)
    if (entry.process == ::getpid()) words.push_back(entry.path.string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv("/bin/sh", arguments.data());
  std::error_code ignored;  // without a shell: removed by this program
  for (std::size_t i = 5; i < words.size(); ++i) fs::remove_all(words[i], ignored);
  std::fprintf(stderr, "%s\n", line.c_str());
  ::_exit(1);
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
  const std::lock_guard lock(registry().mutex);
  for (const fs::path& path : paths_) take_off(registry().entries, path);
  if (!paths_.empty()) registry().finished.push_back({absolute_path(paths_.front()), ::getpid()});
  paths_.clear();
}

std::error_code UnfinishedOutput::rename_to(const fs::path& target) {
  const std::lock_guard lock(registry().mutex);
  std::error_code error;
  fs::rename(paths_.front(), target, error);
  if (error) return error;
  registry().finished.push_back({absolute_path(target), ::getpid()});
  take_off(registry().entries, paths_.front());
  paths_.clear();
  return {};
}

}  // namespace core
}  // namespace trocar
