#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Bytes that this user can still write on the file system of a folder; empty if unknown.
std::optional<std::uintmax_t> find_free_bytes(const std::filesystem::path& folder) noexcept;

/// Creates the folder if it is missing and tries to write a file in it. An error has the folder in `where` and the
/// system's reason in `what`; the caller sets `advice`.
Status make_writable_folder(const std::filesystem::path& folder);

}  // namespace core
inline namespace core {

/// Whether a path is a regular file that may be executed.
bool is_program(const std::filesystem::path& path);

/// An executable by its file name: beside the running program, in TROCAR_BIN_DIR, or on PATH, in this order.
std::optional<std::filesystem::path> find_program(std::string_view name);

}  // namespace core
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
