#include "link/detail/private_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace trocar::link::detail {
namespace {

constexpr mode_t kUserAlone = 0700;
constexpr mode_t kOthers = 0077;

}  // namespace

Status check_private_folder(const std::filesystem::path& folder) {
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0)
    return fail(std::strerror(errno), folder.string(), "set XDG_RUNTIME_DIR to a folder of your own");
  if (!S_ISDIR(status.st_mode)) return fail("is no folder", folder.string(), "remove it");
  if (status.st_uid != ::geteuid()) return fail("belongs to another user", folder.string(), "set XDG_RUNTIME_DIR");
  if ((status.st_mode & kOthers) != 0) {
    return fail("is open to other users", folder.string(), fmt::format("chmod 700 {}", folder.string()));
  }
  return {};
}

Status make_private_folder(const std::filesystem::path& folder) {
  if (::mkdir(folder.c_str(), kUserAlone) != 0 && errno != EEXIST) {
    return fail(std::string("cannot create the folder: ") + std::strerror(errno), folder.string(),
                "set XDG_RUNTIME_DIR to a folder of your own");
  }
  return check_private_folder(folder);
}

}  // namespace trocar::link::detail
