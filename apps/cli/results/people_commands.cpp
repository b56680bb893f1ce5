// trocar results people, add, change, pin, delete: who practises.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "cli/secret_line.h"
#include "config/json.h"
#include "results/attempts.h"
#include "results/notes.h"

namespace trocar::cli {
namespace {

using database::Missing;

struct PersonArguments {
  std::string name, new_name, group = "trainee", course, attempt;
  bool is_simulated = false, is_json = false, is_sure = false, has_no_pin = false;
  std::string pins;
};

Result<results::Group> parse_group(const std::string& name) {
  if (const auto group = results::find_group(name)) return *group;
  return fail_usage("unknown group \"" + name + "\"", "--group", "use trainee or expert");
}

Status add_person(const std::string& url, const PersonArguments& arguments) {
  TROCAR_TRY(const results::Group group, parse_group(arguments.group));
  TROCAR_TRY_STATUS(results::clean_name(arguments.name, "the name of a person"));  // before a database is made
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kCreate));
  TROCAR_TRY(
      const results::Person person,
      results::add_person(repository, {arguments.name, group, arguments.course, arguments.is_simulated}, now_s()));
  fmt::print("added {} ({}) to {}\n", person.name, to_string(person.group), repository.url().shown());
  return {};
}

std::string group_text(const results::Person& person) {
  return fmt::format("{}{}", to_string(person.group), person.is_simulated ? ", simulated" : "");
}

Status list_people(const std::string& url, bool is_json) {
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kRefuse));
  TROCAR_TRY(const std::vector<results::Person> people, results::list_people(repository));
  TROCAR_TRY(const std::vector<results::TaskSummary> summaries, results::summarise_tasks(repository));
  std::map<std::string, learning::AttemptCounts> attempts;
  for (const results::TaskSummary& summary : summaries) attempts[summary.person_id].add(summary.counts);
  if (is_json) {
    config::Json list = config::Json::array();
    for (const results::Person& person : people)
      list.push_back({{"id", person.id},
                      {"name", person.name},
                      {"group", to_string(person.group)},
                      {"course", person.course},
                      {"simulated", person.is_simulated},
                      {"pin", person.has_pin},
                      {"attempts", attempts[person.id].counted()},
                      {"counts", counts_json(attempts[person.id])}});
    print_json({{"people", std::move(list)}});
    return {};
  }
  if (people.empty()) fmt::print("nobody yet: add a person with trocar results add NAME\n");
  std::size_t width = 0;
  for (const results::Person& person : people) width = std::max(width, person.name.size());
  for (const results::Person& person : people)
    fmt::print("{:<{}}  {:<18} {:>5} attempts, {:>5} passed  {}{}\n", person.name, width, group_text(person),
               attempts[person.id].counted(), attempts[person.id].passed, person.course,
               person.has_pin ? "  (PIN)" : "");
  learning::AttemptCounts all;
  for (const auto& [id, counts] : attempts) all.add(counts);
  if (!people.empty()) fmt::print("{}\n", learning::counts_text(all));
  return {};
}

Status change(const std::string& url, const PersonArguments& arguments, bool has_group, bool has_course) {
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kRefuse));
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.name));
  TROCAR_TRY(const results::Group group, parse_group(arguments.group));
  if (arguments.new_name.empty() && !has_group && !has_course)
    return fail_usage("nothing to change", arguments.name, "give --name, --group or --course");
  results::PersonChange wished;
  if (has_group) wished.group = group;
  if (has_course) wished.course = arguments.course;
  if (!arguments.new_name.empty()) wished.name = arguments.new_name;
  TROCAR_TRY_STATUS(results::change_person(repository, person.id, wished));
  TROCAR_TRY(const auto changed, results::find_person(repository, person.id));
  if (changed)
    fmt::print("{}: {}{}{}\n", changed->name, group_text(*changed), changed->course.empty() ? "" : ", ",
               changed->course);
  return {};
}

/// From the terminal, else the first line of standard input: never an argument, which others could see.
Result<std::string> read_pin() {
  return is_terminal() ? read_secret_line("New PIN (4 to 12 digits): ") : read_piped_line();
}

Status set_pin(const std::string& url, const PersonArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kRefuse));
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.name));
  std::string pin;
  if (!arguments.has_no_pin) {
    TROCAR_TRY(pin, read_pin());
    if (pin.empty()) return fail_usage("no PIN was given", arguments.name, "type one, or use --none to remove it");
  }
  TROCAR_TRY_STATUS(results::set_pin(repository, person.id, pin));
  fmt::print("{} {} PIN\n", person.name, pin.empty() ? "has no" : "has a new");
  return {};
}

Status change_pins(const std::string& url, const std::string& choice) {
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kCreate));
  TROCAR_TRY_STATUS(results::require_pins(repository, choice == "required"));
  fmt::print("PINs are {}\n", choice);
  return {};
}

Status delete_data(const std::string& url, const PersonArguments& arguments) {
  if (arguments.name.empty() == arguments.attempt.empty())
    return fail_usage("nothing to delete", "trocar results delete", "give either --person or --attempt");
  TROCAR_TRY(results::Repository repository, open_results(url, Missing::kRefuse));
  if (!arguments.attempt.empty()) {
    TROCAR_TRY(const bool is_erased, results::delete_attempt(repository, arguments.attempt));
    if (!is_erased) warn_of_log(repository);
    fmt::print("deleted the attempt\n");
    return {};
  }
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.name));
  TROCAR_TRY(const results::PersonalData data, results::count_personal_data(repository, person.id));
  const std::string what = fmt::format("{} with {} attempts, {} recordings, {} questionnaires", person.name,
                                       data.attempts, data.recordings, data.answers);
  if (!arguments.is_sure) return fail_usage("this deletes " + what + " permanently", person.name, "add --yes to do it");
  TROCAR_TRY(const results::PersonalData deleted, results::delete_person(repository, person.id));
  if (!deleted.is_erased) warn_of_log(repository);
  fmt::print("deleted {}; session files on a station have to be deleted there\n", what);
  return {};
}

}  // namespace

void add_results_people_commands(Command& results, const DatabaseOption& url, Action& action) {
  const auto a = std::make_shared<PersonArguments>();
  Command people = results.add_command("people", "List the people with their groups, courses and attempts");
  people.add_flag("--json", a->is_json, "Print one JSON object");
  people.footer("Example:\n  trocar results people\n");
  people.when_parsed([&action, url, a] { action = [url, a] { return list_people(*url, a->is_json); }; });

  Command added = results.add_command("add", "Add a person");
  added.add_option("name", a->name, "Name, as it is shown").required();
  added.add_option("--group", a->group, "trainee or expert").show_default();
  added.add_option("--course", a->course, "Course; made if it is new");
  added.add_flag("--simulated", a->is_simulated, "A scripted operator; said wherever its results are shown");
  added.footer("Example:\n  trocar results add \"Anna Meier\" --course \"Radiology 2026\"\n");
  added.when_parsed([&action, url, a] { action = [url, a] { return add_person(*url, *a); }; });

  Command changed = results.add_command("change", "Change name, group or course of a person");
  changed.add_option("person", a->name, "Name of the person").required();
  changed.add_option("--name", a->new_name, "New name");
  Option group = changed.add_option("--group", a->group, "trainee or expert");
  Option course = changed.add_option("--course", a->course, "Course; made if it is new");
  changed.footer("Example:\n  trocar results change \"Anna Meier\" --group expert\n");
  changed.when_parsed([&action, url, a, group, course] {
    action = [url, a, group, course] { return change(*url, *a, group.is_given(), course.is_given()); };
  });

  Command pin = results.add_command("pin", "Set or remove the PIN of a person, read from terminal or standard input");
  pin.add_option("person", a->name, "Name of the person").required();
  pin.add_flag("--none", a->has_no_pin, "Remove it");
  pin.footer("Example:\n  trocar results pin \"Anna Meier\"\n");
  pin.when_parsed([&action, url, a] { action = [url, a] { return set_pin(*url, *a); }; });

  Command pins = results.add_command("pins", "Say whether everybody has to have a PIN");
  pins.add_option("choice", a->pins, "required or optional").required().one_of({"required", "optional"});
  pins.footer("Example:\n  trocar results pins required\n");
  pins.when_parsed([&action, url, a] { action = [url, a] { return change_pins(*url, a->pins); }; });

  Command removed = results.add_command("delete", "Delete a person with all data, or one attempt, permanently");
  removed.add_option("--person", a->name, "Name of the person");
  removed.add_option("--attempt", a->attempt, "Key of the attempt; see trocar results list");
  removed.add_flag("--yes", a->is_sure, "Do it; without, the data of the person are only counted");
  removed.footer("Example:\n  trocar results delete --person \"Anna Meier\" --yes\n");
  removed.when_parsed([&action, url, a] { action = [url, a] { return delete_data(*url, *a); }; });
}

}  // namespace trocar::cli
