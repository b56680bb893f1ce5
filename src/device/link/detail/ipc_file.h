#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "core/result.h"

namespace trocar::link::detail {

/// Checks that `folder` is a folder (not a symbolic link) of this user without access for other users. Errors: it is
/// not.
Status check_private_folder(const std::filesystem::path& folder);
/// Like check_private_folder(), but makes the folder, for this user only, if it does not exist.
Status make_private_folder(const std::filesystem::path& folder);

/// Length of a listening socket's queue of connections that wait for accept().
inline constexpr int kWaitingConnections = 64;

/// Owner of a file descriptor.
class Descriptor {
 public:
  Descriptor() noexcept = default;
  explicit Descriptor(int opened) noexcept : number_(opened) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      close();
      number_ = std::exchange(other.number_, -1);
    }
    return *this;
  }
  ~Descriptor() { close(); }

  bool is_open() const noexcept { return number_ >= 0; }
  int get() const noexcept { return number_; }
  void close() noexcept {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_ = -1;
};

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
