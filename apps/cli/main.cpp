#include <optional>
#include <string>

#include "cli/commands.h"
#include "core/interruption.h"
#include "core/log.h"
#include "core/version.h"
#include "program_end.h"

namespace trocar::cli {
namespace {

int run(int argc, char** argv) {
  arguments::Program program("trocar", "Trocar: a training simulator for needle punctures. Not a medical device.");
  program.add_version_flag(std::string("trocar ") + kVersion, "Print the version and exit");
  program.refuse_empty_texts();
  bool is_verbose = false;
  program.add_flag("-v,--verbose", is_verbose, "Print details to stderr");
  program.require_command();
  program.footer("Example:\n  trocar run liver-biopsy --patient abdomen --operator expert --out first.session\n");
  Action action;
  add_patient_commands(program, action);
  add_plan_command(program, action);
  add_task_commands(program, action);
  add_run_command(program, action);
  add_session_commands(program, action);
  add_learn_command(program, action);
  add_results_commands(program, action);
  add_exam_commands(program, action);
  add_serve_command(program, action);
  add_device_commands(program, action);
  add_link_commands(program, action);
  add_ultrasound_commands(program, action);
  add_xray_command(program, action);
  add_register_command(program, action);
  add_bench_command(program, action, {argv, argv + argc});
  add_completion_command(program, action);

  if (const std::optional<int> end = program.parse(argc, argv)) return *end;
  if (is_verbose) set_log_level(LogLevel::kInfo);
  const Status done = action();
  return done ? 0 : arguments::report_error(done.error());
}

}  // namespace
}  // namespace trocar::cli

int main(int argc, char** argv) {
  const bool has_command = argc > 1 && argv[1][0] != '-';
  const auto program = [&] {
    const trocar::Status handled =
        trocar::handle_interruptions(has_command ? std::string("trocar ") + argv[1] : "trocar");
    return handled ? trocar::cli::run(argc, argv) : trocar::arguments::report_error(handled.error());
  };
  return trocar::arguments::run_program(program, "trocar");
}
