#include "core/files/output_check.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kProbeBytes = 4096;  // one block: an empty file fits on a full disk

/// The folder of the output: that of the target, or its nearest existing parent.
fs::path nearest_folder(const fs::path& target) {
  std::error_code ignored;
  fs::path folder = fs::absolute(target, ignored).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  do {
    folder = folder.parent_path();
  } while (folder.has_relative_path() && !fs::exists(fs::symlink_status(folder, ignored)));
  return folder;
}

Status cannot_write(int reason, const fs::path& target) {
  const char* advice = reason == ENOSPC || reason == EDQUOT || reason == EFBIG ? "free some disk space"
                       : reason == ENAMETOOLONG                                ? "choose a shorter name"
                                                                               : "choose another folder";
  return fail(fmt::format("cannot write: {}", std::strerror(reason)), target.string(), advice);
}

}  // namespace

Status check_can_write(const fs::path& target) {
  const fs::path folder = nearest_folder(target);
  const std::string name =
      target.has_filename() ? target.filename().string() : target.parent_path().filename().string();
  // As long as the name of the temporary file of the output.
  const fs::path probe = folder / fmt::format(".{}.{}.part", name, ::getpid());
  const int file = ::open(probe.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (file < 0) return cannot_write(errno, target);
  const std::array<char, kProbeBytes> block{};
  const ssize_t written = ::write(file, block.data(), block.size());
  int reason = written == static_cast<ssize_t>(block.size()) ? 0 : (written < 0 ? errno : ENOSPC);
  if (::close(file) != 0 && reason == 0) reason = errno;
  ::unlink(probe.c_str());
  return reason == 0 ? Status{} : cannot_write(reason, target);
}

}  // namespace core
}  // namespace trocar
