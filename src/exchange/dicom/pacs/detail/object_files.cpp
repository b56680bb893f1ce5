#include "dicom/pacs/detail/object_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/files/input_file.h"

namespace trocar::dicom::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kWriteBufferBytes = std::size_t{1} << 18;
constexpr mode_t kForOwner = 0600;
constexpr mode_t kForAll = 0666;  // less the user's mask

tl::unexpected<Error> cannot_write(const fs::path& path, int reason) {
  return fail(fmt::format("cannot be written: {}", std::strerror(reason)), path.string(),
              "free some disk space or choose another folder");
}

/// 0 or errno.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

/// File systems without nameless files (NFS) get a file whose name is removed at once.
int open_nameless(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kForOwner);
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return descriptor;
  std::string name = (folder / "receivingXXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

ReceivedFile::ReceivedFile(fs::path folder, int descriptor) noexcept
    : folder_(std::move(folder)), descriptor_(descriptor) {}

Result<ReceivedFile> ReceivedFile::create(const fs::path& folder) {
  const int descriptor = open_nameless(folder);
  if (descriptor < 0) return cannot_write(folder, errno);
  return ReceivedFile(folder, descriptor);
}

ReceivedFile::ReceivedFile(ReceivedFile&& other) noexcept
    : folder_(std::move(other.folder_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(std::exchange(other.size_, 0)),
      mapped_(std::exchange(other.mapped_, nullptr)),
      mapped_size_(std::exchange(other.mapped_size_, 0)) {}

ReceivedFile& ReceivedFile::operator=(ReceivedFile&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
  std::swap(mapped_size_, other.mapped_size_);
  return *this;
}

ReceivedFile::~ReceivedFile() {
  unmap();
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ReceivedFile::unmap() noexcept {
  if (mapped_ != nullptr) ::munmap(mapped_, mapped_size_);
  mapped_ = nullptr;
}

Status ReceivedFile::append(std::string_view bytes) {
  const FileLimit& limit = limit_of(FileKind::kDicom);
  if (bytes.size() > limit.max_bytes - size_)
    return fail(fmt::format("the PACS sent an object larger than {} MiB", limit.max_bytes >> 20), "",
                "fetch other series: Trocar reads no DICOM file of this size");
  if (const int error = write_all(descriptor_, bytes); error != 0) return cannot_write(folder_, error);
  size_ += bytes.size();
  return {};
}

Status ReceivedFile::clear() {
  unmap();
  if (::ftruncate(descriptor_, 0) != 0 || ::lseek(descriptor_, 0, SEEK_SET) != 0) return cannot_write(folder_, errno);
  size_ = 0;
  return {};
}

Result<std::string_view> ReceivedFile::bytes() {
  unmap();
  if (size_ == 0) return std::string_view();
  mapped_size_ = static_cast<std::size_t>(size_);
  mapped_ = ::mmap(nullptr, mapped_size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
  if (mapped_ == MAP_FAILED) {
    mapped_ = nullptr;
    return cannot_write(folder_, errno);
  }
  return std::string_view(static_cast<const char*>(mapped_), mapped_size_);
}

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kForAll)) {
  if (descriptor_ < 0) error_ = errno;
  buffer_.reserve(kWriteBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::flush(std::string_view bytes) {
  if (error_ == 0) error_ = write_all(descriptor_, bytes);
}

void OutputFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kWriteBufferBytes) {
    flush(buffer_);
    buffer_.clear();
  }
  if (bytes.size() > kWriteBufferBytes)
    flush(bytes);
  else
    buffer_ += bytes;
}

Status OutputFile::close() {
  flush(buffer_);
  buffer_.clear();
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  if (error_ != 0) return cannot_write(path_, error_);
  return {};
}

}  // namespace trocar::dicom::detail
