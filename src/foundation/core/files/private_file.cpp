#include "core/files/private_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace trocar {
inline namespace core {
namespace {

constexpr mode_t kUserMayReadAndWrite = 0600;
constexpr mode_t kOthers = 0077;
constexpr mode_t kOthersMayWrite = 0022;

bool is_of_user_or_root(const struct stat& status) {
  return status.st_uid == ::geteuid() || status.st_uid == 0;
}

/// A folder without links in its path, and those above it.
Status check_folders(std::filesystem::path folder) {
  while (true) {
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0)
      return fail(std::string("cannot be checked: ") + std::strerror(errno), folder.string(), "check the path");
    if (!is_of_user_or_root(status))
      return fail("the folder of a key belongs to another user, who can replace the key", folder.string(),
                  "move the keys into a folder of your own");
    if ((status.st_mode & kOthersMayWrite) != 0 && (status.st_mode & S_ISVTX) == 0)
      return fail("the folder of a key is writable by other users, who can replace the key", folder.string(),
                  fmt::format("chmod go-w {}, or move the keys into a folder of your own", folder.string()));
    if (!folder.has_relative_path()) return {};
    folder = folder.parent_path();
  }
}

}  // namespace

Status write_private_file(const std::filesystem::path& file, std::string_view text) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUserMayReadAndWrite);
  if (descriptor < 0)
    return fail(std::string("cannot write: ") + std::strerror(errno), file.string(),
                "choose a folder that you may write to");
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  const bool is_flushed = ::fsync(descriptor) == 0;
  const bool is_closed = ::close(descriptor) == 0;
  if (text.empty() && is_flushed && is_closed) return {};
  return fail("cannot be written", file.string(), "free some disk space");
}

Status check_private_file(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return fail("no such file", file.string(), "check the path");
  if ((status.st_mode & kOthers) != 0)
    return fail("the secret key is readable by other users", file.string(),
                fmt::format("chmod 600 {}, or make new keys", file.string()));
  if (!is_of_user_or_root(status))
    return fail("the secret key belongs to another user, who knows it", file.string(), "make new keys");
  return check_folders_of(file);
}

Status check_folders_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical(file, error);
  if (error) return fail("no such file", file.string(), "check the path");
  TROCAR_TRY_STATUS(check_folders(target.parent_path()));
  const std::filesystem::path beside = std::filesystem::absolute(file, error).parent_path();
  return check_folders(std::filesystem::canonical(beside, error));
}

}  // namespace core
}  // namespace trocar
