#pragma once

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "web/security/token_buckets.h"

namespace trocar::web {

struct LoginRules {
  BucketRule pair{5, 1.0 / 60};       ///< Of one account from one address: 5 tries, then one a minute.
  BucketRule address{30, 1.0 / 30};   ///< Of one address at all accounts.
  BucketRule account{100, 1.0 / 60};  ///< Of one account from all addresses that never logged in to it.
};

/// Slows down the guessing of passwords. Nobody is locked out: another address is not slowed by the tries of one, and
/// an address that has logged in to an account is not slowed by those of all others. Thread-safe.
class LoginThrottle {
 public:
  using TimePoint = TokenBuckets::TimePoint;
  explicit LoginThrottle(const LoginRules& rules = {});

  /// Counts a try before its password is checked, so that tries at the same time count, too. Otherwise the time to
  /// wait.
  std::optional<std::chrono::seconds> try_begin(std::string_view account, std::string_view address, TimePoint now);
  /// The password was right: the try does not count.
  void succeeded(std::string_view account, std::string_view address);

 private:
  TokenBuckets pairs_, addresses_, accounts_;
  std::mutex mutex_;
  std::set<std::string> known_;  ///< Pairs that have logged in.
};

}  // namespace trocar::web
