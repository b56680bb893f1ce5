#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "web/security/token_buckets.h"

namespace trocar::web {

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

}  // namespace trocar::web
