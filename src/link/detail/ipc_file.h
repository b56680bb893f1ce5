#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

#include "core/result.h"

namespace trocar::detail {

/// A listening Unix socket and its file, for the user alone (0600). The file goes with it, unless another has taken its
/// place.
class IpcFile {
 public:
  /// The file of a dead server is replaced. Errors: a live server listens there, another kind of file, no such folder.
  static Result<IpcFile> listen(const std::filesystem::path& path);
  IpcFile() noexcept = default;
  IpcFile(IpcFile&& other) noexcept;
  IpcFile& operator=(IpcFile&& other) noexcept;
  ~IpcFile() { remove(); }

  /// The listening descriptor; from now on the caller's.
  int release() noexcept { return std::exchange(descriptor_, -1); }

 private:
  void remove() noexcept;

  std::filesystem::path path_;
  int descriptor_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace trocar::detail
