#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

#include "core/result.h"
#include "link/detail/descriptor.h"

namespace trocar::link::detail {

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

  /// The listening socket.
  int get() const noexcept { return socket_.get(); }

 private:
  void remove() noexcept;

  std::filesystem::path path_;
  Descriptor socket_;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace trocar::link::detail
