#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

#include "core/result.h"
#include "link/detail/descriptor.h"

namespace trocar::link::detail {

/// A listening Unix socket and its file, accessible only to the user (0600). The destructor removes the file, unless
/// another file has replaced it.
class IpcFile {
 public:
  /// Replaces the socket file of a server that has ended. Errors: another server listens there, the path is another
  /// kind of file, no such folder.
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
