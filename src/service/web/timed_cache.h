#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/result.h"
#include "core/start_thread.h"

namespace trocar::web {

struct CacheRules {
  std::chrono::milliseconds fresh{1000};   ///< A value is given again for so long.
  std::chrono::milliseconds stale{10000};  ///< And for so long while the next one is made in the background.
  bool keeps_costly = true;                ///< A value that took long is kept ten times as long.
  std::size_t most_entries = 200;
  std::size_t most_bytes = std::size_t{32} << 20;
};

/// Values by key that are costly to make: 200 readers of one page cost one query a second. A value is made by one
/// thread at a time (single flight): the first request makes it while others wait; later a thread of the cache renews
/// it while requests get the old one; if that thread cannot start, requests make it. Thread-safe. Errors are not kept.
template <class T>
class TimedCache {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Value = std::shared_ptr<const T>;
  /// Owns what it uses: it may be called after the request has ended, until the cache is destroyed.
  using Make = std::function<Result<Value>()>;
  using CountBytes = std::function<std::size_t(const T&)>;

  explicit TimedCache(CountBytes count_bytes, const CacheRules& rules = {})
      : rules_(rules), count_bytes_(std::move(count_bytes)) {
    if (auto thread = start_thread("cache", [this] { renew_all(); })) renewer_ = *std::move(thread);
  }
  ~TimedCache() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    has_work_.notify_all();
    if (renewer_.joinable()) renewer_.join();
  }
  TimedCache(const TimedCache&) = delete;
  TimedCache& operator=(const TimedCache&) = delete;

  /// The value of the key, or that of `make`.
  Result<Value> get(const std::string& key, TimePoint now, const Make& make) {
    std::unique_lock lock(mutex_);
    while (true) {
      Entry& entry = entries_[key];
      const bool is_due = now - entry.made >= std::max<Duration>(rules_.fresh, rest_after(entry));
      const bool is_usable = entry.value && now - entry.made < rules_.stale + rest_after(entry);
      if (is_usable && (!is_due || renewer_.joinable())) {
        if (is_due && !entry.is_being_made) {
          work_.push_back({key, make, now});
          entry.is_being_made = true;
          has_work_.notify_one();
        }
        return entry.value;
      }
      if (!entry.is_being_made) break;
      is_made_.wait(lock);
      const auto found = entries_.find(key);
      if (found != entries_.end() && found->second.value && !found->second.is_being_made) return found->second.value;
    }
    const Work work{key, make, now};
    entries_[key].is_being_made = true;
    return make_now(lock, work);
  }

  /// Forgets all values, also those that are being made: something was changed.
  void clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
    work_.clear();
    bytes_ = 0;
    ++generation_;
    is_made_.notify_all();
  }

  /// Waits until no value is being renewed.
  void finish_renewal() {
    std::unique_lock lock(mutex_);
    is_made_.wait(lock, [this] { return work_.empty() && !is_renewing_; });
  }

 private:
  using Duration = TimePoint::duration;
  static constexpr int kRest = 10;  ///< Times the cost of a value that pass until it is renewed.
  struct Entry {
    Value value;
    std::size_t bytes = 0;
    TimePoint made;
    Duration cost{};
    bool is_being_made = false;
  };
  Duration rest_after(const Entry& entry) const { return rules_.keeps_costly ? kRest * entry.cost : Duration{}; }
  struct Work {
    std::string key;
    Make make;
    TimePoint now;
  };

  static Result<Value> result_of(const Make& make) {
    try {
      return make();
    } catch (const std::exception& error) {  // of a library: others wait for the value
      return fail(std::string("unforeseen error: ").append(error.what()), {}, "try again; if it remains, report it");
    } catch (...) {
      return fail("unforeseen error", {}, "try again; if it remains, report it");
    }
  }

  /// The end of making a value, also by an exception: nobody waits for it any more. With the lock.
  class Making {
   public:
    Making(TimedCache& cache, std::unique_lock<std::mutex>& lock, const std::string& key)
        : cache_(cache), lock_(lock), key_(key), generation_(cache.generation_) {}
    ~Making() {
      if (!lock_.owns_lock()) lock_.lock();
      if (const auto found = cache_.entries_.find(key_); is_wanted() && found != cache_.entries_.end()) {
        found->second.is_being_made = false;
        if (!found->second.value) cache_.entries_.erase(found);
      }
      cache_.is_made_.notify_all();
    }
    Making(const Making&) = delete;
    Making& operator=(const Making&) = delete;
    /// False: everything was forgotten meanwhile.
    bool is_wanted() const { return generation_ == cache_.generation_; }

   private:
    TimedCache& cache_;
    std::unique_lock<std::mutex>& lock_;
    const std::string& key_;
    const std::uint64_t generation_;
  };

  /// Makes a value without the lock and stores it, unless everything was forgotten meanwhile.
  Result<Value> make_now(std::unique_lock<std::mutex>& lock, const Work& work) {
    const Making making(*this, lock, work.key);
    lock.unlock();
    const TimePoint start = std::chrono::steady_clock::now();
    Result<Value> made = result_of(work.make);
    const Duration cost = std::chrono::steady_clock::now() - start;
    const std::size_t bytes = made && *made ? count_bytes_(**made) : 0;
    lock.lock();
    if (!making.is_wanted()) return made;
    Entry& entry = entries_[work.key];
    bytes_ += bytes - entry.bytes;
    entry.value = made ? *made : nullptr;
    entry.bytes = bytes;
    entry.made = work.now;
    entry.cost = cost;
    make_room();
    return made;
  }

  /// An error is made again, and seen, by the next request.
  void renew(std::unique_lock<std::mutex>& lock, const Work& work) noexcept {
    try {
      static_cast<void>(make_now(lock, work));
    } catch (const std::exception&) {
      // The value is not kept.
    }
  }

  void renew_all() {
    std::unique_lock lock(mutex_);
    while (true) {
      has_work_.wait(lock, [this] { return !work_.empty() || is_ending_; });
      if (is_ending_) return;
      const Work work = std::move(work_.front());
      work_.pop_front();
      is_renewing_ = true;
      renew(lock, work);
      is_renewing_ = false;
      is_made_.notify_all();
    }
  }

  /// Removes the oldest values.
  void make_room() {
    while (entries_.size() > rules_.most_entries || bytes_ > rules_.most_bytes) {
      auto oldest = entries_.end();
      for (auto entry = entries_.begin(); entry != entries_.end(); ++entry)
        if (!entry->second.is_being_made && (oldest == entries_.end() || entry->second.made < oldest->second.made))
          oldest = entry;
      if (oldest == entries_.end()) return;
      bytes_ -= oldest->second.bytes;
      entries_.erase(oldest);
    }
  }

  const CacheRules rules_;
  const CountBytes count_bytes_;
  std::mutex mutex_;
  std::condition_variable is_made_, has_work_;
  std::map<std::string, Entry> entries_;
  std::deque<Work> work_;
  std::size_t bytes_ = 0;
  std::uint64_t generation_ = 0;  ///< Of clear().
  bool is_ending_ = false, is_renewing_ = false;
  std::thread renewer_;
};

/// Answers as text.
class AnswerCache : public TimedCache<std::string> {
 public:
  explicit AnswerCache(const CacheRules& rules = {})
      : TimedCache([](const std::string& text) { return text.size(); }, rules) {}
};

}  // namespace trocar::web
