#include "web/security/login_throttle.h"

#include <array>
#include <utility>

#include "web/security/client_address.h"

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

}  // namespace trocar::web
