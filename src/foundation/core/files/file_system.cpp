#include "core/files/file_system.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace trocar {
inline namespace core {
namespace {

constexpr const char* kAdvice = "choose a folder that you can write to";

}  // namespace

std::optional<std::uintmax_t> find_free_bytes(const std::filesystem::path& folder) noexcept {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || space.available == static_cast<std::uintmax_t>(-1)) return std::nullopt;
  return space.available;
}

Status make_writable_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(error.message(), folder.string(), kAdvice);
  std::string trial = (folder / ".trial-XXXXXX").string();
  const int file = ::mkostemp(trial.data(), O_CLOEXEC);
  if (file < 0) return fail(std::strerror(errno), folder.string(), kAdvice);
  ::close(file);
  ::unlink(trial.c_str());
  return {};
}

}  // namespace core
inline namespace core {
namespace fs = std::filesystem;

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

std::optional<fs::path> find_program(std::string_view name) {
  std::error_code ignored;
  const fs::path self = fs::read_symlink("/proc/self/exe", ignored);
  if (const fs::path beside = self.parent_path() / name; !self.empty() && is_program(beside)) return beside;
  const char* folder = std::getenv("TROCAR_BIN_DIR");
  if (folder != nullptr && *folder != '\0' && is_program(fs::path(folder) / name)) return fs::path(folder) / name;
  const char* path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path entry(rest.substr(0, end));
    if (!entry.empty() && is_program(entry / name)) return entry / name;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

}  // namespace core
inline namespace core {
namespace {

constexpr mode_t kForUserAlone = 0600;

/// True if the path still refers to the open file: its holder may have removed it before it released the lock.
bool is_still_there(int file, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

Result<std::optional<FileLock>> FileLock::try_lock(const std::filesystem::path& path) {
  constexpr int kTries = 10;
  for (int n = 0; n < kTries; ++n) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kForUserAlone);
    if (file < 0)
      return fail(std::string("cannot open the lock file: ") + std::strerror(errno), path.string(),
                  "choose another folder");
    FileLock lock(path, file);
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) return std::nullopt;
      return fail(std::string("cannot lock the file: ") + std::strerror(errno), path.string(),
                  "choose a folder on a local disk");
    }
    if (is_still_there(file, path)) return lock;
  }
  return std::nullopt;
}

FileLock::FileLock(FileLock&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  if (this != &other) {
    release();
    path_ = std::move(other.path_);
    file_ = std::exchange(other.file_, -1);
  }
  return *this;
}

FileLock::~FileLock() {
  release();
}

void FileLock::remove() noexcept {
  if (file_ >= 0) ::unlink(path_.c_str());
  release();
}

void FileLock::release() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace core
}  // namespace trocar
