// trocar results list: attempts.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "config/json.h"
#include "results/attempt_json.h"
#include "results/attempts.h"

namespace trocar::cli {
namespace {

struct ListArguments {
  std::string person, task, course, patient, level;
  std::int64_t limit = 50;
  bool is_json = false;
};

std::string verdict_text(const results::Attempt& attempt) {
  if (attempt.score) return fmt::format("{:5.1f} {}", *attempt.score, attempt.is_passed ? "passed" : "not passed");
  return attempt.state == results::State::kUnscored ? "no result" : to_string(attempt.state);
}

std::string case_text(const results::Case& the_case) {
  return plain_line(fmt::format("{}, {}", the_case.task, the_case.patient));
}

config::Json attempt_json(const results::Attempt& attempt, const results::Person& person) {
  config::Json json = results::attempt_json(attempt);
  json["case"] = json["difficulty"];
  json["person"] = person.name;
  json["group"] = to_string(person.group);
  json["simulated"] = person.is_simulated;
  return json;
}

Status list_attempts(const std::string& url, const ListArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  results::AttemptFilter filter{{}, arguments.task, arguments.course, arguments.patient, arguments.level};
  if (!arguments.person.empty()) {
    TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.person));
    filter.person_id = person.id;
  }
  filter.limit = static_cast<std::size_t>(arguments.limit);
  filter.is_newest_first = true;
  TROCAR_TRY(std::vector<results::Attempt> attempts, results::list_attempts(repository, filter));
  std::ranges::reverse(attempts);
  TROCAR_TRY(const learning::AttemptCounts counts, results::count_attempts(repository, filter));
  TROCAR_TRY(const std::vector<results::Person> all, results::list_people(repository));
  std::map<std::string, results::Person> people;
  std::size_t name_width = 0, case_width = 0;
  for (const results::Person& person : all) people[person.id] = person;
  if (arguments.is_json) {
    config::Json json = config::Json::array();
    for (const results::Attempt& attempt : attempts) json.push_back(attempt_json(attempt, people[attempt.person_id]));
    print_json({{"attempts", std::move(json)}, {"counts", counts_json(counts)}});
    return {};
  }
  if (attempts.empty()) fmt::print("no attempts\n");
  for (const results::Attempt& attempt : attempts) {
    name_width = std::max(name_width, people[attempt.person_id].name.size());
    case_width = std::max(case_width, case_text(attempt.the_case).size());
  }
  for (const results::Attempt& attempt : attempts) {
    const results::Person& person = people[attempt.person_id];
    fmt::print("{}  {:<{}}  {:<{}}  {:<9} {:<18} {}{}\n", minute_text(attempt.started), person.name, name_width,
               case_text(attempt.the_case), case_width, attempt.level, verdict_text(attempt), attempt.id,
               person.is_simulated ? "  simulated" : "");
  }
  if (!attempts.empty())
    fmt::print("{}; {} of {} passed\n", learning::counts_text(counts), counts.passed, counts.counted());
  return {};
}

}  // namespace

void add_results_attempt_commands(Command& results, const DatabaseOption& url, Action& action) {
  Command command = results.add_command("list", "List attempts, the newest last");
  const auto a = std::make_shared<ListArguments>();
  command.add_option("--person", a->person, "Only of this person");
  command.add_option("--task", a->task, "Only of this task");
  command.add_option("--course", a->course, "Only of the people of this course");
  command.add_option("--patient", a->patient, "Only at this case: biopsy-2");
  command.add_option("--level", a->level, "Only at this level of help").one_of({"guided", "assisted", "exam"});
  command.add_option("--limit", a->limit, "The newest so many").whole_number_within(1, 1'000'000).show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer("Example:\n  trocar results list --person \"Anna Meier\" --task liver-biopsy\n");
  command.when_parsed([&action, url, a] { action = [url, a] { return list_attempts(*url, *a); }; });
}

}  // namespace trocar::cli
