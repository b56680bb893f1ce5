#include "web/security/login_throttle.h"

namespace trocar::web {
namespace {

constexpr std::size_t kMostKnown = 10000;

std::string pair_of(std::string_view account, std::string_view address) {
  return std::string(address) + "\n" + std::string(account);
}

}  // namespace

LoginThrottle::LoginThrottle(const LoginRules& rules)
    : pairs_(rules.pair), addresses_(rules.address), accounts_(rules.account) {}

std::optional<std::chrono::seconds> LoginThrottle::try_begin(std::string_view account, std::string_view address,
                                                             TimePoint now) {
  if (const auto wait = addresses_.try_take(address, now)) return wait;
  const std::string pair = pair_of(account, address);
  if (const auto wait = pairs_.try_take(pair, now)) return wait;
  {
    const std::lock_guard lock(mutex_);
    if (known_.contains(pair)) return std::nullopt;
  }
  return accounts_.try_take(account, now);
}

void LoginThrottle::succeeded(std::string_view account, std::string_view address) {
  const std::string pair = pair_of(account, address);
  addresses_.give_back(address);
  pairs_.give_back(pair);
  const std::lock_guard lock(mutex_);
  if (!known_.contains(pair)) accounts_.give_back(account);
  if (known_.size() < kMostKnown) known_.insert(pair);
}

}  // namespace trocar::web
