#include "core/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace trocar {
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
