#include "results/login_clients.h"

#include <fmt/format.h>

#include "results/names.h"

namespace trocar::results {

Status note_login_client(Repository& repository, std::string_view account_id, std::string_view client, Seconds now) {
  return repository.database().transaction("the login cannot be written", [&](soci::session& session) {
    const std::string account(account_id), address(client);
    const long long now_s = now.time_since_epoch().count(),
                    oldest_s = (now - kLoginClientKept).time_since_epoch().count();
    session << "INSERT INTO login_clients (account_id, client, used_s) VALUES (:a, :c, :n)"
               " ON CONFLICT (account_id, client) DO UPDATE SET used_s = excluded.used_s",
        soci::use(account), soci::use(address), soci::use(now_s);
    session << "DELETE FROM login_clients WHERE used_s < :o OR used_s > :n", soci::use(oldest_s), soci::use(now_s);
    session << fmt::format(
        "DELETE FROM login_clients WHERE account_id = :a AND client NOT IN (SELECT client FROM login_clients"
        " WHERE account_id = :b ORDER BY used_s DESC, client LIMIT {})",
        kMostLoginClients),
        soci::use(account), soci::use(account);
  });
}

Result<bool> is_login_client(Repository& repository, std::string_view account_name, std::string_view client,
                             Seconds now) {
  return repository.database().run("the logins cannot be read", [&](soci::session& session) {
    const std::string key = name_key(account_name), address(client);
    const long long now_s = now.time_since_epoch().count(),
                    oldest_s = (now - kLoginClientKept).time_since_epoch().count();
    int count = 0;
    session << "SELECT count(*) FROM login_clients k JOIN accounts a ON a.id = k.account_id"
               " WHERE a.name_key = :n AND k.client = :c AND k.used_s >= :o AND k.used_s <= :t",
        soci::use(key), soci::use(address), soci::use(oldest_s), soci::use(now_s), soci::into(count);
    return count > 0;
  });
}

}  // namespace trocar::results
