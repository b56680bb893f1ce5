// trocar exam: the number of an exam, signed results and their check.
#include <fmt/format.h>

#include <random>

#include "commands.h"
#include "config/json.h"
#include "core/files/atomic_file.h"
#include "core/files/user_folders.h"
#include "exams/exam_body.h"
#include "exams/exam_result.h"
#include "io/patient/patient_cache.h"
#include "past_sessions.h"
#include "storage/session_summary.h"
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
  std::string file, key, state, sessions;
};

fs::path state_folder(const std::string& given) {
  return given.empty() ? user_state_folder() : fs::path(given);
}

Status draw(const DrawArguments& arguments) {
  TROCAR_TRY(const fs::path tasks_folder, find_data("tasks"));
  TROCAR_TRY_STATUS(tasks::load_task(tasks_folder, arguments.task));
  TROCAR_TRY(const std::string patient,
             exams::patient_of_difficulty(arguments.task, static_cast<int>(arguments.difficulty)));
  TROCAR_TRY(const learning::History history, read_past_sessions(arguments.sessions));
  exams::ExamBody body;
  {
    const ProgressPrinter printer;
    const exams::FitCheck check =
        exams::fit_check(arguments.task, patient, io::patient_cache_folder(), printer.callback());
    std::random_device random;
    TROCAR_TRY(body, arguments.number == 0 ? exams::draw_body(patient, history.attempts, random(), check)
                                           : exams::find_body(patient, arguments.number, history.attempts, check));
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

Status sign(const ResultArguments& arguments) {
  TROCAR_TRY_STATUS(storage::load_summary(arguments.file));  // before a key is made, and before warnings about others
  TROCAR_TRY(const auto key, signing::open_station_key(state_folder(arguments.state) / exams::kStationKeyFile));
  TROCAR_TRY(const learning::History history,
             read_past_sessions(arguments.sessions.empty() ? fs::absolute(arguments.file).parent_path().string()
                                                           : arguments.sessions));
  TROCAR_TRY(const fs::path result, exams::sign_exam(arguments.file, history.attempts, key));
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
  Command sign_command = exam.add_command("sign", "Sign the session of an exam; the trainer does it by itself");
  sign_command.add_option("SESSION", a->file, "Session of an exam").required();
  sign_command.add_option("--sessions", a->sessions, "Folder of sessions whose bodies are known [that of the session]");
  add_state_option(sign_command, a);
  sign_command.footer("Example:\n  trocar exam sign exam.trocar\n");
  sign_command.when_parsed([&action, a] { action = [a] { return sign(*a); }; });

  Command verify_command = exam.add_command("verify", "Check the signature of a result, and the session beside it");
  verify_command.add_option("RESULT", a->file, "Result of an exam (.result.json)").required();
  verify_command.add_option("--key", a->key, "Public key of the station, or a file with it [this station's]");
  add_state_option(verify_command, a);
  verify_command.footer(
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
