#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// An exclusive advisory lock on a file, held during the lifetime of this object. The system releases it when the
/// process ends for any reason; child processes do not inherit it. The file stays unless remove() is called.
class FileLock {
 public:
  /// Creates the file if necessary. Empty if another process or object holds the lock. Errors: the file cannot be
  /// opened or locked.
  static Result<std::optional<FileLock>> try_lock(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();

  /// Removes the file and releases the lock.
  void remove() noexcept;

 private:
  FileLock(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}
  void release() noexcept;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace core
}  // namespace trocar
