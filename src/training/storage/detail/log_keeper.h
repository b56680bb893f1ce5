#pragma once

#include <chrono>
#include <filesystem>
#include <thread>

#include "core/result.h"

namespace trocar::storage::detail {

/// Moves the write-ahead log of a session into its file on a thread of its own, so that a recording program never waits
/// for the disk: the writer's connection does not, with `wal_autocheckpoint` = 0 and `synchronous` = OFF. What was
/// moved is on the disk as with `synchronous` = NORMAL. Ends, and closes its connection, with its owner.
class LogKeeper {
 public:
  /// Error: no thread can start; then the writer keeps its own settings.
  Status start(const std::filesystem::path& session, std::chrono::milliseconds interval = std::chrono::seconds(5));
  void stop() noexcept { thread_ = {}; }  // stops and joins

 private:
  std::jthread thread_;
};

}  // namespace trocar::storage::detail
