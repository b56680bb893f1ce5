// trocar serve account: who may log in to the instructor's page.
#include "cli/results/serve_accounts.h"

#include <fmt/format.h>

#include <chrono>

#include "cli/results/commands.h"
#include "cli/secret_line.h"
#include "results/accounts.h"
#include "results/names.h"
#include "results/repository.h"
#include "signing/password.h"

namespace trocar::cli {
namespace {

struct AccountArguments {
  std::string database, name, role = "instructor";
  bool is_from_input = false;
};

/// Twice from the terminal, or the first line of standard input.
Result<std::string> read_new_password(const AccountArguments& arguments) {
  std::string password;
  if (arguments.is_from_input) {
    TROCAR_TRY(password, read_piped_line());
  } else {
    if (!is_terminal())
      return fail_usage("standard input is not a terminal", "password", "add --password-stdin to read it from there");
    TROCAR_TRY(password, read_secret_line("Password (12 to 128 characters): "));
    TROCAR_TRY(const std::string again, read_secret_line("Again: "));
    if (again != password) return fail_usage("the passwords differ", "password", "run the command again");
  }
  TROCAR_TRY_STATUS(signing::check_new_password(password, arguments.name));
  return password;
}

results::Seconds now() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

Result<results::Repository> open(const AccountArguments& arguments) {
  TROCAR_TRY(const database::DatabaseUrl url, database_of(arguments.database));
  TROCAR_TRY(results::Repository repository, results::Repository::open(url));
  warn_of_journal(repository);
  return repository;
}

Status add_account(const AccountArguments& arguments) {
  const auto role = results::find_role(arguments.role);
  if (!role) return fail_usage("there is no such role", "--role " + arguments.role, "choose admin or instructor");
  TROCAR_TRY(const std::string name, results::clean_account_name(arguments.name));
  TROCAR_TRY(results::Repository repository, open(arguments));
  TROCAR_TRY(const auto other, results::find_account(repository, name));
  if (other) return fail_usage("the name is taken", other->name, "choose another name");
  TROCAR_TRY(const std::string password, read_new_password(arguments));
  TROCAR_TRY(const std::string hash, signing::hash_password(password));
  TROCAR_TRY(const results::Account account, results::add_account(repository, name, *role, hash, now()));
  fmt::print("{} may log in as {}\n", account.name, results::to_string(account.role));
  return {};
}

Status print_accounts(const AccountArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open(arguments));
  TROCAR_TRY(const std::vector<results::Account> accounts, results::list_accounts(repository));
  for (const results::Account& account : accounts)
    fmt::print("{:<10} {}\n", results::to_string(account.role), account.name);
  if (accounts.empty()) print_warning("there is no account; see trocar serve account add --help");
  return {};
}

Status remove(const AccountArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open(arguments));
  TROCAR_TRY_STATUS(results::remove_account(repository, arguments.name));
  warn_of_log(repository);
  fmt::print("{} can no longer log in\n", arguments.name);
  return {};
}

Status change_password(const AccountArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open(arguments));
  TROCAR_TRY(const auto account, results::find_account(repository, arguments.name));
  if (!account) return fail_usage("no such account", arguments.name, "see trocar serve account list");
  TROCAR_TRY(const std::string password, read_new_password(arguments));
  TROCAR_TRY(const std::string hash, signing::hash_password(password));
  TROCAR_TRY_STATUS(results::change_password(repository, account->id, hash));
  fmt::print("{} has a new password; its logins have ended\n", account->name);
  return {};
}

using Work = Status (*)(const AccountArguments&);

void add_password_option(Command& command, AccountArguments& a) {
  command.add_flag("--password-stdin", a.is_from_input, "Read the password from standard input, one line");
}

}  // namespace

Result<database::DatabaseUrl> database_of(const std::string& option) {
  return option.empty() ? results::default_url() : database::parse_url(option);
}

void add_serve_account_commands(Command& serve, Action& action) {
  Command account = serve.add_command("account", "Manage who may log in");
  account.require_command();
  const auto a = std::make_shared<AccountArguments>();
  const Option db_of_serve = serve.option("--db");  // may stand before `account`, too
  const auto add_command = [&](const char* name, const char* description, Work work) {
    Command command = account.add_command(name, description);
    command.add_option("--db", a->database, kDatabaseHelp);
    if (work != print_accounts) command.add_option("NAME", a->name, "Name of the account").required();
    command.when_parsed([&action, a, work, db_of_serve] {
      if (a->database.empty() && db_of_serve.is_given()) a->database = db_of_serve.texts().back();
      action = [a, work] { return work(*a); };
    });
    return command;
  };
  Command adding = add_command("add", "Add an account; asks for its password", add_account);
  adding.add_option("--role", a->role, "admin (also accounts and deletion of people) or instructor").show_default();
  add_password_option(adding, *a);
  adding.footer(
      "Examples:\n  trocar serve account add \"Dr. Weber\" --role admin\n"
      "  pwgen 20 1 | tee /dev/tty | trocar serve account add guest --password-stdin\n");
  add_command("list", "List the accounts", print_accounts);
  add_command("remove", "Remove an account and end its logins", remove);
  Command changing = add_command("password", "Set a new password and end the logins", change_password);
  add_password_option(changing, *a);
}

}  // namespace trocar::cli
