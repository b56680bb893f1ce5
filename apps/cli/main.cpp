#include <CLI/CLI.hpp>

#include "commands.h"
#include "core/interruption.h"
#include "core/log.h"
#include "core/version.h"
#include "program_end.h"

namespace {

using namespace trocar::cli;

/// The command that was parsed when an error occurred.
const CLI::App& deepest_command(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

/// An option that was given an empty text, as from an unset variable of a shell; null: none. It would read as an option
/// that was left out.
const CLI::Option* find_empty(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& text : option->results())
      if (text.empty()) return option;
  for (const CLI::App* below : command.get_subcommands())
    if (const CLI::Option* option = find_empty(*below)) return option;
  return nullptr;
}

int report_usage(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = deepest_command(program);
  const std::string name = full_name(command);
  std::string what = error.what();
  if (command.get_require_subcommand_min() > 0) {
    const auto rest = command.remaining();
    what = rest.empty() ? "a command is missing" : "unknown command \"" + rest.front() + "\"";
  }
  return trocar::arguments::report_error({what, name, "see " + name + " --help", 2});
}

int run(int argc, char** argv) {
  CLI::App program("Trocar: a training simulator for needle punctures. Not a medical device.");
  program.name("trocar");
  program.set_version_flag("--version", std::string("trocar ") + trocar::kVersion, "Print the version and exit");
  bool is_verbose = false;
  program.add_flag("-v,--verbose", is_verbose, "Print details to stderr");
  program.require_subcommand(1);
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
  add_bench_command(program, action);
  add_completion_command(program, action);

  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked_for_text) {
    return program.exit(asked_for_text);
  } catch (const CLI::ParseError& error) {
    return report_usage(program, error);
  }
  if (const CLI::Option* option = find_empty(program))
    return trocar::arguments::report_error(
        {option->get_name() + " is empty", full_name(deepest_command(program)), "give a value or leave it out", 2});
  if (is_verbose) trocar::set_log_level(trocar::LogLevel::kInfo);
  const trocar::Status done = action();
  return done ? 0 : trocar::arguments::report_error(done.error());
}

}  // namespace

int main(int argc, char** argv) {
  const bool has_command = argc > 1 && argv[1][0] != '-';
  trocar::handle_interruptions(has_command ? std::string("trocar ") + argv[1] : "trocar");
  return trocar::arguments::run_program([&] { return run(argc, argv); }, "trocar");
}
