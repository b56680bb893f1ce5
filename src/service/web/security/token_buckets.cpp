#include "web/security/token_buckets.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace trocar::web {
namespace {

constexpr std::string_view kShared = "";  ///< The bucket of all keys beyond the limit.

}  // namespace

TokenBuckets::TokenBuckets(const BucketRule& rule) : rule_(rule) {
  TROCAR_CHECK(rule.capacity >= 1.0 && rule.per_second > 0.0);
}

void TokenBuckets::fill(Bucket& bucket, TimePoint now) const {
  if (now <= bucket.filled) return;
  const double seconds = std::chrono::duration<double>(now - bucket.filled).count();
  bucket.tokens = std::min(rule_.capacity, bucket.tokens + seconds * rule_.per_second);
  bucket.filled = now;
}

TokenBuckets::Bucket& TokenBuckets::bucket_of(std::string_view key, TimePoint now) {
  const auto found = buckets_.find(std::string(key));
  if (found != buckets_.end()) return found->second;
  if (buckets_.size() >= rule_.most_keys) {
    // A full bucket holds no memory of anything.
    for (auto entry = buckets_.begin(); entry != buckets_.end();) {
      fill(entry->second, now);
      entry = entry->second.tokens >= rule_.capacity ? buckets_.erase(entry) : std::next(entry);
    }
    if (buckets_.size() >= rule_.most_keys) key = kShared;
  }
  return buckets_.try_emplace(std::string(key), Bucket{rule_.capacity, now}).first->second;
}

std::optional<std::chrono::seconds> TokenBuckets::try_take(std::string_view key, TimePoint now) {
  const std::lock_guard lock(mutex_);
  Bucket& bucket = bucket_of(key, now);
  fill(bucket, now);
  if (bucket.tokens >= 1.0) {
    bucket.tokens -= 1.0;
    return std::nullopt;
  }
  const double seconds = std::ceil((1.0 - bucket.tokens) / rule_.per_second);
  return std::chrono::seconds(std::max<std::int64_t>(1, static_cast<std::int64_t>(seconds)));
}

void TokenBuckets::give_back(std::string_view key) {
  const std::lock_guard lock(mutex_);
  const auto found = buckets_.find(std::string(key));
  if (found != buckets_.end()) found->second.tokens = std::min(rule_.capacity, found->second.tokens + 1.0);
}

}  // namespace trocar::web
