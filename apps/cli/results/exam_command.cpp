// trocar exam: the number of an exam, signed results and their check.
#include <fmt/format.h>

#include <random>

#include "cli/commands.h"
#include "cli/results/commands.h"
#include "cli/results/serve_accounts.h"
#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "exams/exam_body.h"
#include "exams/exam_result.h"
#include "io/patient/patient_cache.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostKeyBytes = 4096;
constexpr std::int64_t kFirstNumber = exams::kPractisedNumber + 1;

struct DrawArguments {
  std::string task, sessions;
  std::int64_t difficulty = 1;
  std::uint64_t number = 0;  ///< 0: drawn.
  bool is_json = false;
};

struct ResultArguments {
  std::string file, key, state, sessions, database;
};

fs::path state_folder(const std::string& given) {
  return given.empty() ? user_state_folder() : fs::path(given);
}

/// The bodies in a folder of sessions; empty: those of the trainer, which need not exist.
Result<std::vector<exams::SeenBody>> seen_in(const std::string& folder) {
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error))
    return fail_usage("no such folder", folder, "name a folder of session files");
  TROCAR_TRY(exams::SeenBodies seen,
             exams::seen_on_station(folder.empty() ? user_state_folder() / "sessions" : fs::path(folder)));
  for (const std::string& line : seen.damaged) print_warning(line);
  return std::move(seen.attempts);
}

Status draw(const DrawArguments& arguments) {
  TROCAR_TRY(const fs::path tasks_folder, find_data("tasks"));
  TROCAR_TRY_STATUS(tasks::load_task(tasks_folder, arguments.task));
  TROCAR_TRY(const std::string patient,
             exams::patient_of_difficulty(arguments.task, static_cast<int>(arguments.difficulty)));
  TROCAR_TRY(const std::vector<exams::SeenBody> history, seen_in(arguments.sessions));
  exams::ExamBody body;
  {
    const ProgressPrinter printer;
    const exams::FitCheck check =
        exams::fit_check(arguments.task, patient, io::patient_cache_folder(), printer.callback());
    std::random_device random;
    TROCAR_TRY(body, arguments.number == 0 ? exams::draw_body(patient, history, random(), check)
                                           : exams::find_body({patient, arguments.number}, history, {}, check));
  }
  for (const std::uint64_t unfit : body.unfit)
    print_warning(fmt::format("exam {} was not taken: its body cannot serve the task", unfit));
  if (arguments.is_json) {
    print_json({{"task", arguments.task},
                {"patient", patient},
                {"difficulty", arguments.difficulty},
                {"exam_number", body.number},
                {"body_was_known", body.is_known},
                {"unfit", body.unfit}});
  } else {
    fmt::print("exam {} of {}, difficulty {} (patient {}, seed {}){}\n", body.number, arguments.task,
               arguments.difficulty, patient, body.number,
               body.is_known ? ": known, an attempt of this folder was on this body" : "");
  }
  return {};
}

/// The attempts of who was examined: the sessions beside the exam, and what the database of results has of the person.
Result<std::vector<exams::SeenBody>> history_of(const ResultArguments& arguments, const std::string& person_id) {
  TROCAR_TRY(
      std::vector<exams::SeenBody> history,
      seen_in(arguments.sessions.empty() ? fs::absolute(arguments.file).parent_path().string() : arguments.sessions));
  if (person_id.empty()) return history;
  TROCAR_TRY(const database::DatabaseUrl url, database_of(arguments.database));
  std::error_code error;
  if (arguments.database.empty() && url.is_sqlite() && !fs::exists(url.file, error)) {
    print_warning(fmt::format(
        "the person's attempts on other stations do not count: there is no database of results — {} — name one with "
        "--db",
        url.file.string()));
    return history;
  }
  TROCAR_TRY(results::Repository repository, open_results(arguments.database, database::Missing::kRefuse));
  TROCAR_TRY(const std::vector<exams::SeenBody> recorded, exams::seen_by_person(repository, person_id));
  history.insert(history.end(), recorded.begin(), recorded.end());
  return history;
}

Status sign(const ResultArguments& arguments) {
  TROCAR_TRY(const storage::SessionSummary exam, exams::load_exam(arguments.file));
  const fs::path key_file = state_folder(arguments.state) / exams::kStationKeyFile;
  std::error_code error;
  if (!fs::exists(key_file, error))
    return fail("this station has no key, so it has sealed no exam", key_file.string(),
                "sign on the station of the exam, or name the folder of its key with --state");
  TROCAR_TRY(const auto key, signing::load_station_key(key_file));
  TROCAR_TRY(const std::vector<exams::SeenBody> history, history_of(arguments, exam.info.person_id));
  TROCAR_TRY(const fs::path result, exams::sign_exam(arguments.file, history, key));
  fmt::print("{}\n", result.string());
  return {};
}

/// A public key as 64 hexadecimal digits, or a file that holds it; empty: the station's own.
Result<signing::PublicKey> trusted_key(const ResultArguments& arguments) {
  if (arguments.key.empty()) {
    const fs::path file = state_folder(arguments.state) / exams::kStationKeyFile;
    std::error_code error;
    if (!fs::exists(file, error))
      return fail_usage("this station has no key", file.string(), "give the key of the other station with --key");
    TROCAR_TRY(const auto key, signing::load_station_key(file));
    return key.public_key();
  }
  if (const auto key = signing::parse_public_key(arguments.key)) return *key;
  std::error_code error;
  if (fs::exists(arguments.key, error)) {
    TROCAR_TRY(std::string text, read_file(arguments.key, kMostKeyBytes));
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
    if (const auto key = signing::parse_public_key(text)) return *key;
  }
  return fail_usage("is no public key", arguments.key,
                    "give the 64 digits that trocar exam key prints on the station, or a file with them");
}

/// Exit status 1 of `verify` says that the result is not to be relied on; a check that cannot be made has the status 2.
template <class T>
Result<T> without_verdict(Result<T> checked) {
  if (!checked) checked.error().exit_status = 2;
  return checked;
}

Status verify(const ResultArguments& arguments) {
  TROCAR_TRY(const signing::PublicKey key, without_verdict(trusted_key(arguments)));
  TROCAR_TRY(const exams::Verification verification, without_verdict(exams::verify_exam(arguments.file, key)));
  if (!verification.is_valid()) return fail(verification.text, arguments.file, "do not rely on this result");
  fmt::print("{}\n", verification.text);
  for (const std::string& line : verification.details) fmt::print("{}\n", line);
  return {};
}

Status print_key(const ResultArguments& arguments) {
  TROCAR_TRY(const auto key, signing::open_station_key(state_folder(arguments.state) / exams::kStationKeyFile));
  fmt::print("{}\n", signing::to_hex(key.public_key()));
  return {};
}

void add_state_option(Command& command, const std::shared_ptr<ResultArguments>& arguments) {
  command.add_option("--state", arguments->state, "Folder of the station's key [$XDG_STATE_HOME/trocar]");
}

void add_draw(Command& exam, Action& action) {
  Command command = exam.add_command("draw", "Draw the number of an exam on an unseen body, or check a number");
  const auto a = std::make_shared<DrawArguments>();
  command.add_option("TASK,--task", a->task, "Task; see trocar task list").required();
  command.add_option("--difficulty", a->difficulty, "Difficulty of the case").whole_number_within(1, 5).show_default();
  command.add_option("--number", a->number, "Check this exam instead of drawing one")
      .whole_number_within(kFirstNumber, static_cast<std::int64_t>(exams::kMostNumber));
  command.add_option(
      "--sessions", a->sessions,
      "Folder of sessions whose bodies are known [those of the trainer: $XDG_STATE_HOME/trocar/sessions]");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer("Example:\n  trocar exam draw liver-biopsy --difficulty 2\n");
  command.when_parsed([&action, a] { action = [a] { return draw(*a); }; });
}

void add_result_commands(Command& exam, Action& action) {
  const auto a = std::make_shared<ResultArguments>();
  Command sign_command = exam.add_command("sign", "Make the result of an exam that the trainer sealed");
  sign_command.add_option("SESSION", a->file, "Session of an exam").required();
  sign_command.add_option("--sessions", a->sessions, "Folder of sessions whose bodies are known [that of the session]");
  sign_command.add_option("--db", a->database, "Database with the person's attempts; see trocar results --help");
  add_state_option(sign_command, a);
  sign_command.footer(
      "The trainer seals an exam (.seal.json) when the attempt ends, and makes the result by itself. This command "
      "makes "
      "it again, if it is lost or could not be made. A session without a seal, or changed since, is refused.\n"
      "Example:\n  trocar exam sign exam.trocar\n");
  sign_command.when_parsed([&action, a] { action = [a] { return sign(*a); }; });

  Command verify_command = exam.add_command("verify", "Check the signature of a result, and the session beside it");
  verify_command.add_option("RESULT", a->file, "Result of an exam (.result.json)").required();
  verify_command.add_option("--key", a->key, "Public key of the station, or a file with it [this station's]");
  add_state_option(verify_command, a);
  verify_command.footer(
      "The lines say who was examined, whether the body was known, what the signature proves and what not.\n"
      "Exit status: 0 valid, also if it was signed by another version of the program, which is said; 1 changed, or "
      "signed with another key; 2 no result, no key.\n"
      "Example:\n  trocar exam verify exam.result.json --key station.pub\n");
  verify_command.when_parsed([&action, a] { action = [a] { return verify(*a); }; });

  Command key_command = exam.add_command("key", "Print the public key of this station");
  add_state_option(key_command, a);
  key_command.footer("Example:\n  trocar exam key > station.pub\n");
  key_command.when_parsed([&action, a] { action = [a] { return print_key(*a); }; });
}

}  // namespace

void add_exam_commands(Command& program, Action& action) {
  Command exam = program.add_command("exam", "Exams on unseen bodies with signed results");
  exam.require_command();
  exam.footer("Example:\n  trocar exam verify exam.result.json --key station.pub\n");
  add_draw(exam, action);
  add_result_commands(exam, action);
}

}  // namespace trocar::cli
