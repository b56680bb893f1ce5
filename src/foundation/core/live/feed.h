#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace trocar {
inline namespace core {

/// Passes the newest value from one writing thread to any number of readers: tool poses, images, the state of an
/// attempt. Nobody waits: a reader that is late misses values and costs the writer nothing. Values are immutable; the
/// lock is held to copy a pointer. For real-time threads use realtime::TripleBuffer, which has no lock.
template <class T>
class Feed {
 public:
  /// A value and its number: numbers grow by 1 with each value, from 1; 0: none yet. A reader compares numbers to see
  /// whether a value is new, and how many it has missed.
  struct Item {
    std::shared_ptr<const T> value;  ///< Null before the first one, and after clear().
    std::uint64_t number = 0;
  };

  void publish(std::shared_ptr<const T> value) {
    {
      const std::lock_guard lock(mutex_);
      ++item_.number;
      item_.value.swap(value);
    }
    value.reset();  // the former one, without the lock
  }
  void publish(T value) { publish(std::make_shared<const T>(std::move(value))); }
  /// Withdraws the value; the numbers go on.
  void clear() { publish(std::shared_ptr<const T>()); }

  Item newest() const {
    const std::lock_guard lock(mutex_);
    return item_;
  }
  std::shared_ptr<const T> value() const { return newest().value; }  ///< Of newest().

 private:
  mutable std::mutex mutex_;
  Item item_;
};

}  // namespace core
}  // namespace trocar
