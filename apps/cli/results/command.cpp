// trocar results: people, attempts, learning curves, proficiency and validity from the database of results.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/results/commands.h"
#include "cli/results/serve_accounts.h"
#include "results/repository.h"

namespace trocar::cli {

Result<results::Repository> open_results(const std::string& url, database::Missing missing) {
  TROCAR_TRY(const database::DatabaseUrl parsed, database_of(url));
  auto repository = results::Repository::open(parsed, missing);
  if (!repository && repository.error().what == "no such database")
    repository.error().advice =
        "nothing was recorded yet: add a person with trocar results add, or name another with --db";
  if (repository) warn_of_journal(*repository);
  return repository;
}

void warn_of_journal(results::Repository& repository) {
  if (const std::string note = repository.database().note(); !note.empty()) print_warning(note);
}

void warn_of_log(results::Repository& repository) {
  if (results::erase_deleted(repository, std::chrono::milliseconds(0)).value_or(false)) return;
  print_warning(
      fmt::format("{}-wal still has what was deleted, because another program reads the database: it is erased "
                  "when that program ends, or with the next deletion",
                  repository.url().shown()));
}

std::string minute_text(results::Seconds time) {
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

results::Seconds now_s() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

void add_results_commands(Command& program, Action& action) {
  Command results = program.add_command("results", "People, their attempts, learning curves, proficiency and validity");
  results.require_command();
  const auto url = std::make_shared<std::string>();
  results.add_option("--db", *url,
                     "Database: an SQLite file, or postgresql://USER:PASSWORD@HOST/NAME [$TROCAR_DB, else "
                     "results.sqlite in $XDG_DATA_HOME/trocar]");
  results.footer(
      "Examples:\n  trocar results add \"Anna Meier\" --course \"Radiology 2026\"\n"
      "  trocar results import sessions/*.trocar --person \"Anna Meier\"\n  trocar results list --task liver-biopsy\n"
      "  trocar results --db postgresql://trocar@db.example/trocar people\n");
  add_results_people_commands(results, url, action);
  add_results_attempt_commands(results, url, action);
  add_results_exchange_commands(results, url, action);
  add_results_curve_command(results, url, action);
  add_results_proficiency_command(results, url, action);
  add_results_validity_command(results, url, action);
}

}  // namespace trocar::cli
