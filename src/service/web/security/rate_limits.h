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

struct LoginRules {
  BucketRule pair{5, 1.0 / 60};       ///< Of one account from one client: 5 tries, then one a minute.
  BucketRule client{30, 1.0 / 30};    ///< Of one client at all accounts from which it never logged in.
  BucketRule network{20, 1.0 / 180};  ///< Of one account from all such clients of one network.
  BucketRule account{100, 1.0 / 60};  ///< Of one account from all such clients.
};

/// A try to log in. `client`: see client_of.
struct LoginTry {
  std::string account, client;
  bool is_known = false;  ///< Somebody has logged in to this account from this client before.
};

/// Slows down the guessing of passwords. A known client is slowed only by tries at the same account from itself; others
/// are slowed by those of their network, too, and by those of five networks or more at once. A try that is refused
/// counts for nothing. Thread-safe.
class LoginThrottle {
 public:
  using TimePoint = TokenBuckets::TimePoint;
  explicit LoginThrottle(const LoginRules& rules = {});

  /// Counts a try before its password is checked, so that tries at the same time count, too. Otherwise the time to
  /// wait.
  std::optional<std::chrono::seconds> try_begin(const LoginTry& login, TimePoint now);
  /// The password was right: the try does not count.
  void succeeded(const LoginTry& login);

 private:
  TokenBuckets pairs_, clients_, networks_, accounts_;
};

/// The time of a request. Delays are measured by the steady clock, which nobody sets; logins are stored by the
/// calendar.
struct Moment {
  std::chrono::steady_clock::time_point steady;
  std::chrono::sys_seconds utc;
};

}  // namespace trocar::web
