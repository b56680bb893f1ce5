#include "core/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/files/input_file.h"
#include "core/files/part_folder.h"
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
}  // namespace trocar
