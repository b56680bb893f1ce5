#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "option.h"

namespace CLI {
class App;
}

namespace trocar::arguments {

template <class Type, class... Types>
concept OneOf = (std::same_as<Type, Types> || ...);

/// Types of the variables that options fill; command.cpp instantiates the code for each.
template <class Type>
concept OptionValue = OneOf<Type, std::string, double, int, std::int64_t, std::uint64_t, std::filesystem::path,
                            std::optional<std::string>, std::optional<double>, std::optional<int>,
                            std::optional<std::uint64_t>, std::vector<std::string>, std::vector<double>>;

/// A command with its options and sub-commands. A handle: copies are the same command, which lives as long as its
/// Program. Variables of options must live until the command line is parsed.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_command(const std::string& name, const std::string& description);
  void require_command();  ///< It is a usage error to leave out the sub-command.

  /// `names` is "--seed", "-s,--seed", for an argument by its place "TASK", and for both "TASK,--task".
  template <OptionValue Value>
  Option add_option(const std::string& names, Value& value, const std::string& description);
  Option add_flag(const std::string& names, bool& is_given, const std::string& description);
  /// A flag and its contrary: "--harmonic,!--no-harmonic". Without either `is_given` stays empty.
  Option add_flag(const std::string& names, std::optional<bool>& is_given, const std::string& description);
  Option add_flag(const std::string& names, std::function<void()> when_given, const std::string& description);

  void footer(const std::string& text);              ///< Of the help: examples.
  void when_parsed(std::function<void()> function);  ///< Called if this command was given, after its sub-commands.

  std::string name() const;
  std::vector<Command> commands() const;
  std::vector<Option> options() const;           ///< All, also --help.
  Option option(const std::string& name) const;  ///< The option `name`, which there must be.
  bool has_given_command() const;                ///< Whether one of its sub-commands was given.

 private:
  CLI::App* app_;
};

/// The command line of a program.
class Program : public Command {
 public:
  Program(const std::string& name, const std::string& description);
  ~Program();
  Program(Program&&) = delete;

  void add_version_flag(const std::string& text, const std::string& description);
  /// An option with an empty text, as from an unset variable of a shell, becomes a usage error: it would read as an
  /// option that was left out.
  void refuse_empty_texts() { are_empty_refused_ = true; }

  /// Fills the variables and calls the functions of the given commands. Returns the exit status if the program has to
  /// end: it has printed a help or the version, or a usage error.
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  explicit Program(std::unique_ptr<CLI::App> app);

  std::unique_ptr<CLI::App> owned_;
  bool are_empty_refused_ = false;
};

}  // namespace trocar::arguments
