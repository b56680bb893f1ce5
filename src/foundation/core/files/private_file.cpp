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

}  // namespace

Status write_private_file(const std::filesystem::path& file, std::string_view text) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUserMayReadAndWrite);
  if (descriptor < 0)
    return fail(std::string("cannot be made: ") + std::strerror(errno), file.string(),
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
  if ((status.st_mode & kOthers) == 0) return {};
  return fail("the secret key is readable by other users", file.string(),
              fmt::format("chmod 600 {}, or make new keys", file.string()));
}

}  // namespace core
}  // namespace trocar
