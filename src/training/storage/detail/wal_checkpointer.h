#pragma once

#include <chrono>
#include <filesystem>
#include <thread>

#include "core/result.h"

namespace trocar::storage::detail {

/// Checkpoints the write-ahead log of a session on a thread of its own: copies what was committed into the database
/// file, so that a recording program does not wait for the disk. The writer's connection then neither checkpoints nor
/// syncs (`wal_autocheckpoint` = 0, `synchronous` = OFF). A checkpoint syncs both files, as with `synchronous` =
/// NORMAL.
class WalCheckpointer {
 public:
  /// Opens a second connection. Error: it does not open, or no thread can start; then the writer checkpoints itself.
  Status start(const std::filesystem::path& session, std::chrono::milliseconds interval = std::chrono::seconds(5));
  /// Waits for the running checkpoint and closes the connection; the destructor does, too.
  void stop() noexcept { thread_ = {}; }

 private:
  std::jthread thread_;
};

}  // namespace trocar::storage::detail
