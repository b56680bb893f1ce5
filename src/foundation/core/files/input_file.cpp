#include "core/files/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "core/result.h"

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// Assumed: several times the largest file of this kind found in practice.
constexpr std::array kLimits{
    FileLimit{FileKind::kToml, "TOML file", 1 * kMiB},
    FileLimit{FileKind::kJson, "JSON file", 8 * kMiB},
    FileLimit{FileKind::kMarkups, "markups file", 8 * kMiB},
    FileLimit{FileKind::kTransform, "transform file", 1 * kMiB},
    FileLimit{FileKind::kXml, "XML file", 1 * kMiB},
    FileLimit{FileKind::kMesh, "surface file", 256 * kMiB},
    FileLimit{FileKind::kVolume, "volume", 16 * kGiB},
    FileLimit{FileKind::kDicom, "DICOM file", 1 * kGiB},
    FileLimit{FileKind::kSequence, "tracked sequence", 4 * kGiB},
    FileLimit{FileKind::kSession, "session", 4 * kGiB},
    FileLimit{FileKind::kOther, "file", 1 * kGiB},
};

std::string size_text(std::uint64_t bytes) {
  if (bytes >= kGiB && bytes % kGiB == 0) return fmt::format("{} GiB", bytes / kGiB);
  if (bytes >= kMiB && bytes % kMiB == 0) return fmt::format("{} MiB", bytes / kMiB);
  return fmt::format("{} bytes", bytes);
}

tl::unexpected<Error> too_large(const fs::path& path, const FileLimit& limit) {
  return fail(fmt::format("too large for a {}: the limit is {}", limit.name, size_text(limit.max_bytes)), path.string(),
              "check that this is the right file");
}

tl::unexpected<Error> cannot_open(const fs::path& path, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) return fail("no such file", path.string(), "check the path");
  if (reason == ELOOP) return fail("circular symbolic links", path.string(), "check the path");
  if (reason == EACCES) return fail("no permission to read", path.string(), "check the permissions");
  return fail(fmt::format("cannot be opened: {}", std::strerror(reason)), path.string(), "check the file");
}

Status check_kind(const struct stat& status, const fs::path& path) {
  if (S_ISREG(status.st_mode)) return {};
  if (S_ISDIR(status.st_mode)) return fail("is a folder, not a file", path.string(), "name a file");
  return fail("not a regular file", path.string(), "name a file, not a pipe, socket or device");
}

/// True if an open file is below a folder, both according to the kernel.
bool is_inside(const fs::path& pinned_path, const fs::path& folder) {
  std::error_code error;
  const fs::path file = fs::read_symlink(pinned_path, error);
  if (error) return false;
  const fs::path root = fs::canonical(folder, error);
  if (error) return false;
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end == root.end();
}

}  // namespace

std::span<const FileLimit> file_limits() noexcept {
  return kLimits;
}

const FileLimit& limit_of(FileKind kind) {
  const auto found =
      std::find_if(kLimits.begin(), kLimits.end(), [&](const FileLimit& limit) { return limit.kind == kind; });
  TROCAR_CHECK(found != kLimits.end());
  return *found;
}

InputFile::InputFile(fs::path path, int descriptor, FileLimit limit)
    : path_(std::move(path)), descriptor_(descriptor), limit_(limit) {}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      limit_(other.limit_) {}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(limit_, other.limit_);
  return *this;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<InputFile> InputFile::open(const fs::path& path, FileKind kind, const fs::path& inside) {
  return open(path, limit_of(kind), inside);
}

Result<InputFile> InputFile::open(const fs::path& path, const FileLimit& limit, const fs::path& inside) {
  // Checked before it is opened: opening some devices has side effects. O_NONBLOCK: opening a FIFO would block.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return cannot_open(path, errno);
  TROCAR_TRY_STATUS(check_kind(status, path));
  InputFile file(path, ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC), limit);
  if (file.descriptor_ < 0) return cannot_open(path, errno);
  if (::fstat(file.descriptor_, &status) != 0) return cannot_open(path, errno);
  TROCAR_TRY_STATUS(check_kind(status, path));
  if (!inside.empty() && !is_inside(file.pinned_path(), inside))
    return fail("a link leads out of the folder", path.string(), "put the file itself into the folder");
  file.size_ = static_cast<std::uint64_t>(status.st_size);
  if (file.size_ > limit.max_bytes) return too_large(path, limit);
  return file;
}

fs::path InputFile::pinned_path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

Result<std::string> InputFile::read_all() const {
  std::string bytes;
  try {
    // Files below /proc have no size; a file can grow while it is read.
    bytes.resize(static_cast<std::size_t>(size_) + 1);
    std::size_t done = 0;
    while (true) {
      const ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        return fail(fmt::format("cannot be read: {}", std::strerror(errno)), path_.string(), "check the file");
      done += static_cast<std::size_t>(got);
      if (done > limit_.max_bytes) return too_large(path_, limit_);
      if (got == 0) break;
      if (done == bytes.size()) bytes.resize(done + kChunkBytes);
    }
    bytes.resize(done);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the file", path_.string(), "close other programs");
  }
  return bytes;
}

Result<std::string> read_input(const fs::path& path, FileKind kind, const fs::path& inside) {
  TROCAR_TRY(const InputFile file, InputFile::open(path, kind, inside));
  return file.read_all();
}

}  // namespace core
}  // namespace trocar
