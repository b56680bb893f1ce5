#include "web/security/rate_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/result.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

std::string pair_of(std::string_view account, std::string_view address) {
  return std::string(address) + "\n" + std::string(account);
}

}  // namespace

LoginThrottle::LoginThrottle(const LoginRules& rules)
    : pairs_(rules.pair), clients_(rules.client), networks_(rules.network), accounts_(rules.account) {}

std::optional<std::chrono::seconds> LoginThrottle::try_begin(const LoginTry& login, TimePoint now) {
  const std::array<std::pair<TokenBuckets*, std::string>, 4> needed{
      {{&pairs_, pair_of(login.account, login.client)},
       {&clients_, login.client},
       {&networks_, pair_of(login.account, network_of(login.client))},
       {&accounts_, login.account}}};
  const std::size_t count = login.is_known ? 1 : needed.size();
  for (std::size_t n = 0; n < count; ++n) {
    const auto wait = needed[n].first->try_take(needed[n].second, now);
    if (!wait) continue;
    while (n-- > 0) needed[n].first->give_back(needed[n].second);
    return wait;
  }
  return std::nullopt;
}

void LoginThrottle::succeeded(const LoginTry& login) {
  pairs_.give_back(pair_of(login.account, login.client));
  if (login.is_known) return;
  clients_.give_back(login.client);
  networks_.give_back(pair_of(login.account, network_of(login.client)));
  accounts_.give_back(login.account);
}

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
