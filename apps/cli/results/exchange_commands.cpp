// trocar results import, export: session files and CSV.
#include <fmt/format.h>

#include <filesystem>

#include "cli/results/commands.h"
#include "learning/curriculum.h"
#include "learning/history.h"
#include "results/attempts_csv.h"
#include "results/names.h"
#include "results/people.h"
#include "results/sessions.h"

namespace trocar::cli {
namespace fs = std::filesystem;
namespace {

struct ImportArguments {
  std::vector<std::string> files;
  std::string person, group, course;
  bool is_simulated = false;
};

struct ExportArguments {
  std::string csv, attempt, out, person, task, course;
};

/// The person of --person, added if there is none of this name; empty: the files name theirs.
Result<std::string> importing_person(results::Repository& repository, const ImportArguments& arguments) {
  if (arguments.person.empty()) return std::string();
  const auto group = arguments.group.empty() ? results::Group::kTrainee : results::find_group(arguments.group);
  if (!group) return fail_usage("unknown group \"" + arguments.group + "\"", "--group", "use trainee or expert");
  TROCAR_TRY(const results::PersonOfName found,
             results::find_or_add_person(
                 repository, {arguments.person, *group, arguments.course, arguments.is_simulated}, now_s()));
  const results::Person& person = found.person;
  // What is said of a person has to be so: the group decides with whom the attempts are compared.
  const bool is_other =
      (!arguments.group.empty() && person.group != *group) || (arguments.is_simulated && !person.is_simulated) ||
      (!arguments.course.empty() && results::name_key(person.course) != results::name_key(arguments.course));
  if (is_other)
    return fail_usage(fmt::format("\"{}\" is {}{}{}", person.name,
                                  person.is_simulated                       ? "a simulated "
                                  : person.group == results::Group::kExpert ? "an "
                                                                            : "a ",
                                  to_string(person.group), person.course.empty() ? "" : " of " + person.course),
                      "--person", "leave out --group, --course and --simulated, or see trocar results change");
  if (found.is_added)
    fmt::print("added {} ({}{})\n", person.name, to_string(person.group), person.is_simulated ? ", simulated" : "");
  return person.id;
}

/// The files, and the session files of the folders among them.
Result<std::vector<fs::path>> all_files(const std::vector<std::string>& given) {
  std::vector<fs::path> files;
  for (const std::string& name : given) {
    std::error_code error;
    if (!fs::exists(name, error)) return fail_usage("no such file", name, "check the path");
    if (!fs::is_directory(name, error)) {
      files.emplace_back(name);
      continue;
    }
    TROCAR_TRY(const std::vector<fs::path> sessions, learning::find_sessions(name));
    files.insert(files.end(), sessions.begin(), sessions.end());
  }
  return files;
}

Status import_files(const std::string& url, const ImportArguments& arguments) {
  TROCAR_TRY(const std::vector<fs::path> files, all_files(arguments.files));
  TROCAR_TRY(const fs::path tasks, find_data("tasks"));
  TROCAR_TRY(const learning::Curriculum curriculum, learning::load_curriculum(tasks.parent_path()));
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kCreate));
  TROCAR_TRY(const std::string person, importing_person(repository, arguments));
  std::int64_t added = 0, present = 0, bad = 0;
  learning::AttemptCounts counts;
  const auto import_file = [&](const fs::path& file) -> Status {
    if (file.extension() == ".csv") {
      TROCAR_TRY(const results::ImportedRows rows, results::import_attempts(repository, file, now_s()));
      added += rows.added;
      present += rows.present;
      counts.add(rows.counts);
      return {};
    }
    TROCAR_TRY(const auto written, results::import_session(repository, file, person, curriculum));
    ++(written ? added : present);
    if (written) counts.add(results::ending_of(written->state), written->is_passed);
    return {};
  };
  {
    const ProgressPrinter printer;
    const Progress progress = printer.callback();
    for (std::size_t n = 0; n < files.size(); ++n) {
      core::report(progress, files[n].filename().string(), static_cast<double>(n) / static_cast<double>(files.size()));
      const Status imported = import_file(files[n]);
      if (!imported && files.size() == 1) return imported;
      if (!imported) print_warning(imported.error().text());
      bad += imported ? 0 : 1;
    }
  }
  fmt::print("{} attempts added, {} were there already{} ({})\n", added, present,
             bad > 0 ? fmt::format(", {} files were not imported", bad) : "", repository.url().shown());
  if (added > 0) fmt::print("of the added: {}\n", learning::counts_text(counts));
  if (bad == 0) return {};
  return fail(fmt::format("{} of {} files were not imported", bad, files.size()), repository.url().shown(),
              "see the warnings above");
}

Status export_results(const std::string& url, const ExportArguments& arguments) {
  if (arguments.csv.empty() == arguments.attempt.empty())
    return fail_usage("nothing to export", "trocar results export",
                      "give either --csv FILE, or --attempt KEY --out FILE");
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  if (!arguments.attempt.empty()) {
    TROCAR_TRY_STATUS(check_new(arguments.out));
    TROCAR_TRY_STATUS(results::export_session(repository, arguments.attempt, arguments.out));
    fmt::print("wrote {}\n", arguments.out);
    return {};
  }
  TROCAR_TRY_STATUS(check_new(arguments.csv, "--csv"));
  results::AttemptFilter filter{{}, arguments.task, arguments.course};
  if (!arguments.person.empty()) {
    TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.person));
    filter.person_id = person.id;
  }
  TROCAR_TRY_STATUS(results::export_attempts(repository, filter, arguments.csv));
  fmt::print("wrote {}\n", arguments.csv);
  return {};
}

}  // namespace

void add_results_exchange_commands(Command& results, const DatabaseOption& url, Action& action) {
  Command imported = results.add_command("import", "Record session files, or attempts from a CSV file");
  const auto i = std::make_shared<ImportArguments>();
  imported.add_option("files", i->files, "Session files, folders of them, CSV files of results export").required();
  imported.add_option("--person", i->person, "Whose sessions they are, added if new [who the sessions name]");
  imported.add_option("--group", i->group, "Group of a new person: trainee or expert [trainee]");
  imported.add_option("--course", i->course, "Course of a new person");
  imported.add_flag("--simulated", i->is_simulated, "A new person is a scripted operator");
  imported.footer(
      "Examples:\n  trocar results import first.session --person \"Anna Meier\"\n"
      "  trocar results import attempts.csv\n");
  imported.when_parsed([&action, url, i] { action = [url, i] { return import_files(*url, *i); }; });

  Command exported = results.add_command("export", "Write attempts as CSV, or the session file of one attempt");
  const auto e = std::make_shared<ExportArguments>();
  exported.add_option("--csv", e->csv, "CSV file to write, one row an attempt");
  exported.add_option("--attempt", e->attempt, "Key of an attempt; see trocar results list");
  exported.add_option("--out", e->out, "Session file to write, with --attempt");
  exported.add_option("--person", e->person, "Only of this person");
  exported.add_option("--task", e->task, "Only of this task");
  exported.add_option("--course", e->course, "Only of the people of this course");
  exported.footer(
      "Examples:\n  trocar results export --csv attempts.csv --course \"Radiology 2026\"\n"
      "  trocar results export --attempt 3f0a9c… --out replay.session\n");
  exported.when_parsed([&action, url, e] { action = [url, e] { return export_results(*url, *e); }; });
}

}  // namespace trocar::cli
