#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "results/repository.h"

namespace trocar::web {

/// Sees once a second whether any program has deleted something, and takes it out of the write-ahead log as soon as
/// nobody reads by it. Thread-safe.
class DeletionWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// True for one thread a second.
  bool is_due(TimePoint now);
  /// Whether something was deleted since the last look.
  Result<bool> look(results::Repository& repository);

 private:
  std::mutex time_mutex_, look_mutex_;
  bool has_looked_ = false, has_to_erase_ = false;
  TimePoint looked_;
  std::string last_;  ///< results::last_deletion.
};

}  // namespace trocar::web
