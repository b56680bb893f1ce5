#include "link/detail/ipc_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

namespace trocar::link::detail {
namespace fs = std::filesystem;
namespace {

constexpr mode_t kForUserAlone = 0600;

std::optional<sockaddr_un> socket_name(const fs::path& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.native().empty() || path.native().size() >= sizeof name.sun_path) return {};
  std::memcpy(name.sun_path, path.c_str(), path.native().size());
  return name;
}

const sockaddr* as_ipc_address(const sockaddr_un& name) {
  return reinterpret_cast<const sockaddr*>(&name);
}

/// A process listens, or may listen: only a refused connection proves that the server has ended.
bool is_alive(const sockaddr_un& name) {
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  return ::connect(probe.get(), as_ipc_address(name), sizeof name) == 0 || (errno != ECONNREFUSED && errno != ENOENT);
}

/// Removes the files of a server that has ended.
Status clear_place(const fs::path& path, const sockaddr_un& name) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return {};
  if (!S_ISSOCK(found.st_mode)) {
    return fail("the path exists and is not a socket", path.string(), "choose another endpoint");
  }
  if (is_alive(name)) {
    return fail("the endpoint is in use by another server", path.string(), "end that one or choose another endpoint");
  }
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
    return fail("cannot remove the socket of a server that has ended", path.string(), std::strerror(errno));
  }
  return {};
}

}  // namespace

Result<IpcFile> IpcFile::listen(const fs::path& path) {
  const auto name = socket_name(path);
  if (!name) return fail_usage("the name of the socket is empty or too long", path.string(), "choose a shorter path");

  // Two servers that start at the same time lock in turn, so that neither removes the new socket of the other. A lock
  // held by another process must not block this server.
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const Descriptor turn(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!turn.is_open()) return fail("the folder of the socket cannot be opened", folder.string(), std::strerror(errno));
  ::flock(turn.get(), LOCK_EX | LOCK_NB);

  TROCAR_TRY_STATUS(clear_place(path, *name));
  Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  // The mode of the descriptor becomes that of the file: other users can connect at no time.
  struct stat made {};
  if (!listener.is_open() || ::fchmod(listener.get(), kForUserAlone) != 0 ||
      ::bind(listener.get(), as_ipc_address(*name), sizeof *name) != 0 ||
      ::listen(listener.get(), kWaitingConnections) != 0 || ::lstat(path.c_str(), &made) != 0) {
    if (errno == EADDRINUSE)
      return fail("the endpoint is in use by another server", path.string(),
                  "stop that server, or choose another endpoint");
    return fail("cannot create the socket", path.string(), std::strerror(errno));
  }
  IpcFile file;
  file.path_ = path;
  file.socket_ = std::move(listener);
  file.device_ = made.st_dev;
  file.inode_ = made.st_ino;
  return file;
}

IpcFile::IpcFile(IpcFile&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      socket_(std::move(other.socket_)),
      device_(other.device_),
      inode_(other.inode_) {}

IpcFile& IpcFile::operator=(IpcFile&& other) noexcept {
  if (this != &other) {
    remove();
    path_ = std::exchange(other.path_, {});
    socket_ = std::move(other.socket_);
    device_ = other.device_;
    inode_ = other.inode_;
  }
  return *this;
}

void IpcFile::remove() noexcept {
  socket_.close();
  if (path_.empty()) return;
  struct stat found {};
  if (::lstat(path_.c_str(), &found) == 0 && found.st_dev == device_ && found.st_ino == inode_) {
    ::unlink(path_.c_str());
  }
  path_.clear();
}

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
