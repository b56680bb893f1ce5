#include "command.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "program_end.h"

namespace trocar::arguments {
namespace {

/// The command that was being parsed when an error occurred.
const CLI::App& deepest_command(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

int report_usage(const CLI::App& command, std::string what, std::string advice = {}) {
  const std::string name = full_name(command);
  if (advice.empty()) advice = "see " + name + " --help";
  return report_error({std::move(what), name, std::move(advice), 2});
}

int report_parse_error(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = deepest_command(program);
  if (command.get_require_subcommand_min() == 0) return report_usage(command, error.what());
  const std::vector<std::string> rest = command.remaining();
  return report_usage(command, rest.empty() ? "a command is missing" : "unknown command \"" + rest.front() + "\"");
}

/// The first option of the given commands that has an empty text; null: none.
const CLI::Option* find_empty(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& text : option->results())
      if (text.empty()) return option;
  for (const CLI::App* below : command.get_subcommands())
    if (const CLI::Option* option = find_empty(*below)) return option;
  return nullptr;
}

}  // namespace

Command Command::add_command(const std::string& name, const std::string& description) {
  return Command(*app_->add_subcommand(name, description));
}

void Command::require_command() {
  app_->require_subcommand(1);
}

template <OptionValue Value>
Option Command::add_option(const std::string& names, Value& value, const std::string& description) {
  return Option(*app_->add_option(names, value, description));
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, std::int64_t&, const std::string&);
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<double>&, const std::string&);

Option Command::add_flag(const std::string& names, bool& is_given, const std::string& description) {
  return Option(*app_->add_flag(names, is_given, description));
}

Option Command::add_flag(const std::string& names, std::optional<bool>& is_given, const std::string& description) {
  return Option(*app_->add_flag_function(
      names, [&is_given](std::int64_t count) { is_given = count > 0; }, description));
}

Option Command::add_flag(const std::string& names, std::function<void()> when_given, const std::string& description) {
  return Option(*app_->add_flag_callback(names, std::move(when_given), description));
}

void Command::footer(const std::string& text) {
  app_->footer(text);
}

void Command::when_parsed(std::function<void()> function) {
  app_->callback(std::move(function));
}

std::string Command::name() const {
  return app_->get_name();
}

std::vector<Command> Command::commands() const {
  std::vector<Command> commands;
  for (CLI::App* command : app_->get_subcommands([](CLI::App*) { return true; })) commands.emplace_back(*command);
  return commands;
}

std::vector<Option> Command::options() const {
  std::vector<Option> options;
  for (CLI::Option* option : app_->get_options({})) options.emplace_back(*option);
  return options;
}

Option Command::option(const std::string& name) const {
  return Option(*app_->get_option(name));
}

bool Command::has_given_command() const {
  return !app_->get_subcommands().empty();
}

Program::Program(const std::string& name, const std::string& description)
    : Program(std::make_unique<CLI::App>(description, name)) {}

Program::Program(std::unique_ptr<CLI::App> app) : Command(*app), owned_(std::move(app)) {}

Program::~Program() = default;

void Program::add_version_flag(const std::string& text, const std::string& description) {
  owned_->set_version_flag("--version", text, description);
}

std::optional<int> Program::parse(int argc, const char* const* argv) {
  try {
    owned_->parse(argc, argv);
  } catch (const CLI::Success& asked_for_text) {
    return owned_->exit(asked_for_text);
  } catch (const CLI::ParseError& error) {
    return report_parse_error(*owned_, error);
  }
  const CLI::Option* empty = are_empty_refused_ ? find_empty(*owned_) : nullptr;
  if (empty == nullptr) return std::nullopt;
  return report_usage(deepest_command(*owned_), empty->get_name() + " is empty", "give a value or leave it out");
}

}  // namespace trocar::arguments
