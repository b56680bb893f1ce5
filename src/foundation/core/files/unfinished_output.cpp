#include "core/files/unfinished_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "core/text.h"

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
inline namespace core {
namespace fs = std::filesystem;
namespace {

constexpr mode_t kForAllUsers = 0777;  // less the user's mask
constexpr int kTriesToCreate = 10;

/// What precedes and follows the number of the process in part_path().
std::pair<std::string, std::string> part_name(const fs::path& target) {
  const bool is_packed = target.filename().string().ends_with(".nii.gz");
  return {fmt::format(".{}.", target.stem().string()),
          fmt::format(".part{}", is_packed ? ".nii.gz" : target.extension().string())};
}

enum class Lock { kTaken, kInUse, kUnknown };

/// A folder that is open, and locked if the file system permits. Links are not followed.
class OpenFolder {
 public:
  explicit OpenFolder(const fs::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
      lock_ = errno == EWOULDBLOCK ? Lock::kInUse : Lock::kUnknown;
    else
      lock_ = is_at(path) ? Lock::kTaken : Lock::kInUse;
  }
  ~OpenFolder() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFolder(const OpenFolder&) = delete;
  OpenFolder& operator=(const OpenFolder&) = delete;

  Lock lock() const { return lock_; }
  bool is_own() const {
    struct stat opened {};
    return ::fstat(descriptor_, &opened) == 0 && opened.st_uid == ::geteuid();
  }
  int release() { return std::exchange(descriptor_, -1); }

 private:
  /// False: its owner has renamed or removed it since it was opened.
  bool is_at(const fs::path& path) const {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor_, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
  }

  int descriptor_ = -1;
  Lock lock_ = Lock::kUnknown;
};

void remove_if_abandoned(const fs::path& path) {
  const OpenFolder folder(path);
  std::error_code ignored;
  if (folder.lock() == Lock::kTaken && folder.is_own()) fs::remove_all(path, ignored);
}

}  // namespace

fs::path part_path(const fs::path& target, int process) {
  const auto [before, after] = part_name(target);
  return target.parent_path() / fmt::format("{}{}{}", before, process, after);
}

Result<PartFolder> PartFolder::create(const fs::path& path) {
  for (int n = 0; n < kTriesToCreate; ++n) {
    remove_if_abandoned(path);
    struct stat existing {};
    if (::lstat(path.c_str(), &existing) == 0)
      return fail("is written by another program", path.string(), "wait for it, or remove this folder if none runs");
    // Registered before it exists, so that an interruption leaves no folder.
    auto unfinished = std::make_unique<UnfinishedOutput>(std::vector{path});
    const bool is_made = ::mkdir(path.c_str(), kForAllUsers) == 0;
    const int reason = errno;
    OpenFolder folder(path);
    if (is_made && folder.lock() != Lock::kInUse) return PartFolder(std::move(unfinished), folder.release());
    // Not ours: another program has made it, or has seen it before it was locked and removes it.
    unfinished->keep();
    forget_finished_output(path);
    if (!is_made && reason != EEXIST)
      return fail(std::string("cannot make the folder: ") + std::strerror(reason), path.string(),
                  "choose another place");
  }
  return fail("cannot lock the folder", path.string(), "try again");
}

PartFolder::PartFolder(std::unique_ptr<UnfinishedOutput> unfinished, int descriptor) noexcept
    : unfinished_(std::move(unfinished)), descriptor_(descriptor) {}

PartFolder::PartFolder(PartFolder&& other) noexcept
    : unfinished_(std::move(other.unfinished_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

PartFolder::~PartFolder() {
  unfinished_.reset();  // while it is locked
  if (descriptor_ >= 0) ::close(descriptor_);
}

void remove_abandoned_parts(const fs::path& target) {
  const auto [before, after] = part_name(target);
  std::vector<fs::path> parts;
  const auto entries = list_folder(target.parent_path());
  if (!entries) return;
  for (const fs::path& entry : *entries) {
    const std::string name = entry.filename().string();
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) continue;
    const std::string_view process =
        std::string_view(name).substr(before.size(), name.size() - before.size() - after.size());
    if (std::ranges::all_of(process, ascii::is_digit)) parts.push_back(entry);
  }
  for (const fs::path& part : parts) remove_if_abandoned(part);
}

}  // namespace core
}  // namespace trocar
