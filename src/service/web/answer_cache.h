#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/result.h"

namespace trocar::web {

struct CacheRules {
  std::chrono::milliseconds fresh{1000};   ///< An answer is given again for so long.
  std::chrono::milliseconds stale{10000};  ///< And for so long while one request makes the next one.
  std::size_t most_entries = 200;
  std::size_t most_bytes = std::size_t{32} << 20;
};

/// Answers by key, made by one thread at a time (single flight): 200 readers of one page cost one query a second.
/// Thread-safe. Errors are not kept.
class AnswerCache {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Value = std::shared_ptr<const std::string>;
  using Make = std::function<Result<Value>()>;
  explicit AnswerCache(const CacheRules& rules = {}) : rules_(rules) {}

  /// The answer of the key, or that of `make`. Threads that ask while another makes it wait for it, or take the stale
  /// one.
  Result<Value> get(const std::string& key, TimePoint now, const Make& make);
  /// Forgets all answers, also those that are being made: something was changed.
  void clear();

 private:
  struct Entry {
    Value value;
    TimePoint made;
    bool is_being_made = false;
  };
  void make_room();

  const CacheRules rules_;
  std::mutex mutex_;
  std::condition_variable is_made_;
  std::map<std::string, Entry> entries_;
  std::size_t bytes_ = 0;
  std::uint64_t generation_ = 0;  ///< Of clear().
};

}  // namespace trocar::web
