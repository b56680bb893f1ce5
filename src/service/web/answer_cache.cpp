#include "web/answer_cache.h"

#include <algorithm>

namespace trocar::web {

Result<AnswerCache::Value> AnswerCache::get(const std::string& key, TimePoint now, const Make& make) {
  std::unique_lock lock(mutex_);
  while (true) {
    Entry& entry = entries_[key];
    if (entry.value && now - entry.made < rules_.fresh) return entry.value;
    if (!entry.is_being_made) break;
    if (entry.value && now - entry.made < rules_.stale) return entry.value;
    is_made_.wait(lock);
    const auto found = entries_.find(key);
    if (found != entries_.end() && found->second.value && !found->second.is_being_made) return found->second.value;
  }
  entries_[key].is_being_made = true;
  const std::uint64_t generation = generation_;
  lock.unlock();
  Result<Value> made = make();
  lock.lock();
  if (generation == generation_) {
    Entry& entry = entries_[key];
    bytes_ -= entry.value ? entry.value->size() : 0;
    entry.is_being_made = false;
    entry.value = made ? *made : nullptr;
    entry.made = now;
    bytes_ += entry.value ? entry.value->size() : 0;
    if (!entry.value) entries_.erase(key);
    make_room();
  }
  is_made_.notify_all();
  return made;
}

void AnswerCache::clear() {
  const std::lock_guard lock(mutex_);
  entries_.clear();
  bytes_ = 0;
  ++generation_;
  is_made_.notify_all();
}

/// Removes the oldest answers.
void AnswerCache::make_room() {
  while (entries_.size() > rules_.most_entries || bytes_ > rules_.most_bytes) {
    auto oldest = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry)
      if (!entry->second.is_being_made && (oldest == entries_.end() || entry->second.made < oldest->second.made))
        oldest = entry;
    if (oldest == entries_.end()) return;
    bytes_ -= oldest->second.value ? oldest->second.value->size() : 0;
    entries_.erase(oldest);
  }
}

}  // namespace trocar::web
