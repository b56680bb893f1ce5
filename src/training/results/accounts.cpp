#include "results/accounts.h"

#include <fmt/format.h>

#include "results/detail/attempt_query.h"
#include "results/names.h"
#include "results/repository.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotReadAccounts = "the accounts cannot be read";
constexpr const char* kCannotWriteAccount = "the account cannot be written";
constexpr const char* kAccountName = "the name of an account";

/// Where the columns of an account are read to.
struct AccountRow {
  Account account;
  int is_admin = 0;
  long long added_s = 0;

  Account get() const {
    Account read = account;
    read.role = is_admin != 0 ? Role::kAdmin : Role::kInstructor;
    read.added = Seconds(std::chrono::seconds(added_s));
    return read;
  }
};

Status no_such_account(const std::string& name) {
  return fail_usage("no such account", name, "see trocar serve account list");
}

}  // namespace

const char* to_string(Role role) noexcept {
  return role == Role::kAdmin ? "admin" : "instructor";
}

std::optional<Role> find_role(std::string_view name) noexcept {
  for (const Role role : {Role::kInstructor, Role::kAdmin})
    if (name == to_string(role)) return role;
  return std::nullopt;
}

Result<std::string> clean_account_name(std::string_view name) {
  TROCAR_TRY(std::string clean, clean_name(name, kAccountName));
  if (clean == "." || clean == ".." || clean.find_first_of("/\\") != std::string::npos)
    return fail_usage("an address cannot contain the name of the account", clean,
                      "use a name without / and \\, other than . and ..");
  return clean;
}

Result<Account> add_account(Repository& repository, std::string_view name, Role role, std::string_view password_hash,
                            Seconds now) {
  TROCAR_TRY(std::string clean, clean_account_name(name));
  return repository.database().transaction(kCannotWriteAccount, [&](soci::session& session) -> Result<Account> {
    const Account account{make_id(), clean, role, std::string(password_hash), now};
    const std::string key = name_key(account.name);
    const int is_admin = role == Role::kAdmin ? 1 : 0;
    const long long now_s = now.time_since_epoch().count();
    soci::statement insert =
        (session.prepare << "INSERT INTO accounts (id, name, name_key, is_admin, password_hash, added_s)"
                            " VALUES (:i, :n, :k, :a, :p, :t) ON CONFLICT (name_key) DO NOTHING",
         soci::use(account.id), soci::use(account.name), soci::use(key), soci::use(is_admin),
         soci::use(account.password_hash), soci::use(now_s));
    insert.execute(true);
    if (insert.get_affected_rows() == 1) return account;
    return fail_usage("the name is taken", account.name, "choose another name");
  });
}

Result<std::vector<Account>> list_accounts(Repository& repository) {
  return repository.database().run(kCannotReadAccounts, [](soci::session& session) {
    std::vector<Account> accounts;
    AccountRow row;
    soci::statement select =
        (session.prepare << "SELECT id, name, is_admin, password_hash, added_s FROM accounts ORDER BY name_key",
         soci::into(row.account.id), soci::into(row.account.name), soci::into(row.is_admin),
         soci::into(row.account.password_hash), soci::into(row.added_s));
    select.execute();
    while (select.fetch()) accounts.push_back(row.get());
    return accounts;
  });
}

Result<std::optional<Account>> find_account(Repository& repository, std::string_view name) {
  const auto clean = clean_name(name, kAccountName);
  if (!clean) return std::optional<Account>();
  return repository.database().run(kCannotReadAccounts, [&](soci::session& session) -> std::optional<Account> {
    const std::string key = name_key(*clean);
    AccountRow row;
    session << "SELECT id, name, is_admin, password_hash, added_s FROM accounts WHERE name_key = :k", soci::use(key),
        soci::into(row.account.id), soci::into(row.account.name), soci::into(row.is_admin),
        soci::into(row.account.password_hash), soci::into(row.added_s);
    return session.got_data() ? std::optional(row.get()) : std::nullopt;
  });
}

Status change_password(Repository& repository, std::string_view account_id, std::string_view password_hash,
                       std::string_view kept_token_hash) {
  return repository.database().transaction(kCannotWriteAccount, [&](soci::session& session) -> Status {
    const std::string id(account_id), hash(password_hash), kept(kept_token_hash);
    soci::statement update =
        (session.prepare << "UPDATE accounts SET password_hash = :p WHERE id = :i", soci::use(hash), soci::use(id));
    update.execute(true);
    if (update.get_affected_rows() != 1) return no_such_account(id);
    session << "DELETE FROM web_sessions WHERE account_id = :i AND token_hash <> :t", soci::use(id), soci::use(kept);
    return {};
  });
}

Status remove_account(Repository& repository, std::string_view name) {
  TROCAR_TRY(const std::optional<Account> account, find_account(repository, name));
  if (!account) return no_such_account(std::string(name));
  const auto removed = repository.database().transaction(kCannotWriteAccount, [&](soci::session& session) -> Status {
    if (account->role == Role::kAdmin) {
      int others = 0;
      // The row is locked until the end, so that two admins cannot remove each other at the same time.
      session << "UPDATE accounts SET is_admin = is_admin WHERE is_admin = 1";
      session << "SELECT count(*) FROM accounts WHERE is_admin = 1 AND id <> :i", soci::use(account->id),
          soci::into(others);
      if (others == 0)
        return fail_usage("it is the last account of an admin", account->name, "add another admin first");
    }
    session << "DELETE FROM accounts WHERE id = :i", soci::use(account->id);
    note_deletion(session);
    return {};
  });
  if (removed) static_cast<void>(erase_deleted(repository));
  return removed;
}

Status add_web_session(Repository& repository, const WebSession& web) {
  return repository.database().transaction("the login cannot be written", [&](soci::session& session) {
    const long long begun_s = web.begun.time_since_epoch().count(), used_s = web.used.time_since_epoch().count();
    session << "INSERT INTO web_sessions (token_hash, account_id, csrf_token, begun_s, used_s)"
               " VALUES (:t, :a, :c, :b, :u)",
        soci::use(web.token_hash), soci::use(web.account.id), soci::use(web.csrf_token), soci::use(begun_s),
        soci::use(used_s);
  });
}

Result<std::optional<WebSession>> find_web_session(Repository& repository, std::string_view token_hash) {
  return repository.database().run(
      "the login cannot be read", [&](soci::session& session) -> std::optional<WebSession> {
        WebSession web;
        web.token_hash = token_hash;
        AccountRow row;
        long long begun_s = 0, used_s = 0;
        session << "SELECT s.csrf_token, s.begun_s, s.used_s, a.id, a.name, a.is_admin, a.password_hash, a.added_s"
                   " FROM web_sessions s JOIN accounts a ON a.id = s.account_id WHERE s.token_hash = :t",
            soci::use(web.token_hash), soci::into(web.csrf_token), soci::into(begun_s), soci::into(used_s),
            soci::into(row.account.id), soci::into(row.account.name), soci::into(row.is_admin),
            soci::into(row.account.password_hash), soci::into(row.added_s);
        if (!session.got_data()) return std::nullopt;
        web.begun = Seconds(std::chrono::seconds(begun_s));
        web.used = Seconds(std::chrono::seconds(used_s));
        web.account = row.get();
        return web;
      });
}

Status touch_web_session(Repository& repository, std::string_view token_hash, Seconds now) {
  return repository.database().transaction("the login cannot be written", [&](soci::session& session) {
    const std::string token(token_hash);
    const long long now_s = now.time_since_epoch().count();
    session << "UPDATE web_sessions SET used_s = :n WHERE token_hash = :t", soci::use(now_s), soci::use(token);
  });
}

Status end_web_session(Repository& repository, std::string_view token_hash) {
  return repository.database().transaction("the login cannot be ended", [&](soci::session& session) {
    const std::string token(token_hash);
    session << "DELETE FROM web_sessions WHERE token_hash = :t", soci::use(token);
  });
}

Status remove_old_web_sessions(Repository& repository, Seconds idle_since, Seconds begun_since, Seconds now) {
  return repository.database().transaction("old logins cannot be removed", [&](soci::session& session) {
    const long long idle_s = idle_since.time_since_epoch().count(), begun_s = begun_since.time_since_epoch().count(),
                    now_s = now.time_since_epoch().count();
    session << "DELETE FROM web_sessions WHERE used_s < :i OR begun_s < :b OR begun_s > :n", soci::use(idle_s),
        soci::use(begun_s), soci::use(now_s);
  });
}

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
