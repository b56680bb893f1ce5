#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace trocar::web {

struct BucketRule {
  double capacity = 20.0;         ///< Tokens of a full bucket: a burst. At least 1.
  double per_second = 1.0;        ///< Tokens that return. Above 0.
  std::size_t most_keys = 10000;  ///< Bounds the memory.
};

/// Token buckets by key (an address, an account). Invariant: at most `most_keys` buckets; when they are all in use, new
/// keys share one bucket, so that made-up keys neither fill the memory nor escape the limit. Thread-safe.
class TokenBuckets {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  explicit TokenBuckets(const BucketRule& rule);

  /// Takes one token. Otherwise the time until there is one; then nothing is taken. A time before the last one counts
  /// as the same moment.
  std::optional<std::chrono::seconds> try_take(std::string_view key, TimePoint now);
  /// Gives a token back.
  void give_back(std::string_view key);

 private:
  struct Bucket {
    double tokens;
    TimePoint filled;
  };
  void fill(Bucket& bucket, TimePoint now) const;
  Bucket& bucket_of(std::string_view key, TimePoint now);

  const BucketRule rule_;
  std::mutex mutex_;
  std::unordered_map<std::string, Bucket> buckets_;
};

}  // namespace trocar::web
