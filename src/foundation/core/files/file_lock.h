#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// An exclusive advisory lock on a file, held while this object lives. The system releases it when the process ends,
/// however it ends; processes started meanwhile do not hold it. The file stays, unless remove() is called.
class FileLock {
 public:
  /// Creates the file where there is none. Empty: somebody else holds the lock, another process or another object of
  /// this one. Errors: the file cannot be opened or locked.
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
