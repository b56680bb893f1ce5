#include "core/files/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/files/input_file.h"
#include "core/files/unfinished_output.h"

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;
namespace {

/// The target without "." and "..", and without a trailing slash.
fs::path plain(const fs::path& target) {
  const fs::path normal = fs::absolute(target).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

fs::path temporary_beside(const fs::path& target) {
  return part_path(plain(target), ::getpid());
}

Status flush_to_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return fail(fmt::format("was not written: {}", std::strerror(errno)), path.string(),
                "free disk space or choose another folder");
  const int status = ::fsync(file);
  const int reason = errno;
  ::close(file);
  if (status != 0)
    return fail(fmt::format("cannot be written: {}", std::strerror(reason)), path.string(), "free some disk space");
  return {};
}

}  // namespace

Status make_parent_folder(const fs::path& target) {
  std::error_code error;
  const fs::path parent = plain(target).parent_path();
  fs::create_directories(parent, error);
  if (error) return fail("cannot make the folder: " + error.message(), parent.string(), "choose another place");
  return {};
}

Status write_atomically(const fs::path& target, const std::function<Status(const fs::path&)>& write) {
  TROCAR_TRY_STATUS(make_parent_folder(target));
  const fs::path temporary = temporary_beside(target);
  UnfinishedOutput unfinished({temporary});
  TROCAR_TRY_STATUS(write(temporary));
  TROCAR_TRY_STATUS(flush_to_disk(temporary));
  if (const std::error_code error = unfinished.rename_to(target))
    return fail("cannot write: " + error.message(), target.string(), "choose another folder");
  return {};
}

Status write_file_atomically(const fs::path& target, std::string_view bytes) {
  return write_atomically(target, [&](const fs::path& temporary) -> Status {
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file)
      return fail(fmt::format("cannot be written: {}", std::strerror(errno)), target.string(),
                  "check the disk space and the permissions");
    return {};
  });
}

Status write_folder_atomically(const fs::path& target, const std::function<Status(const fs::path&)>& write) {
  std::error_code error;
  const bool is_empty_folder = fs::is_directory(target, error) && fs::is_empty(target, error);
  if (fs::exists(target, error) && !is_empty_folder)
    return fail_usage("exists already", target.string(), "choose another name or remove it first");
  TROCAR_TRY_STATUS(make_parent_folder(target));
  const fs::path temporary = temporary_beside(target);
  remove_abandoned_parts(plain(target));
  TROCAR_TRY(PartFolder part, PartFolder::create(temporary));
  TROCAR_TRY_STATUS(write(temporary));
  if (const std::error_code not_renamed = part.rename_to(target))
    return fail("cannot write: " + not_renamed.message(), target.string(), "choose another folder");
  return {};
}

Result<std::string> read_file(const fs::path& path, std::size_t max_bytes) {
  FileLimit limit = limit_of(FileKind::kOther);
  limit.max_bytes = max_bytes;
  TROCAR_TRY(const InputFile file, InputFile::open(path, limit));
  return file.read_all();
}

}  // namespace core
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
