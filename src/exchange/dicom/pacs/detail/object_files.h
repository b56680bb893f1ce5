#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::dicom::detail {

/// One received object in a file without a name: the system deletes it with this process, so that a killed program
/// leaves no identified object on the disk. Its size is limited by that of a DICOM file that Trocar reads.
class ReceivedFile {
 public:
  /// On the file system of `folder`. Errors: the file cannot be created.
  static Result<ReceivedFile> create(const std::filesystem::path& folder);
  ReceivedFile(ReceivedFile&& other) noexcept;
  ReceivedFile& operator=(ReceivedFile&& other) noexcept;
  ~ReceivedFile();

  /// Errors: full disk, object too large.
  Status append(std::string_view bytes);
  /// Empties the file for the next object.
  Status clear();
  std::uint64_t size() const noexcept { return size_; }
  /// All bytes, valid until the file changes. They are mapped, not read: memory does not grow with the object.
  Result<std::string_view> bytes();

 private:
  ReceivedFile(std::filesystem::path folder, int descriptor) noexcept;
  void unmap() noexcept;

  std::filesystem::path folder_;  ///< For messages.
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  void* mapped_ = nullptr;
  std::size_t mapped_size_ = 0;
};

/// A new file that is written through a buffer. The first error is kept until close().
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  /// Errors: of creating and of every write.
  Status close();

 private:
  void flush(std::string_view bytes);

  std::filesystem::path path_;
  int descriptor_ = -1;
  int error_ = 0;  ///< errno
  std::string buffer_;
};

}  // namespace trocar::dicom::detail
