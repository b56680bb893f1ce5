// trocar completion bash: a completion script for the commands and options of this program.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "cli/commands.h"
#include "phantom/phantom.h"
#include "stylus/device_preset.h"
#include "tasks/task.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cli {
namespace {

using Words = std::vector<std::string>;

/// Values of options with a fixed set of names, by the name of the option or argument.
using Values = std::map<std::string, Words>;

template <class Things, class Name>
Words names_of(const Things& things, Name name) {
  Words names;
  for (const auto& thing : things) names.push_back(thing.*name);
  return names;
}

Result<Values> known_values() {
  Values values;
  values["--patient"] = values["PATIENT"] = names_of(phantom::embedded_patients(), &phantom::PhantomInfo::name);
  values["--operator"] = {"expert", "novice", "novice:", "constant-velocity:", "replay:"};
  values["--force-model"] = {"insertion", "proxy", "combined"};
  TROCAR_TRY(const auto tasks_folder, find_data("tasks"));
  TROCAR_TRY(const auto tasks, tasks::load_tasks(tasks_folder));
  values["--task"] = names_of(tasks, &tasks::Task::name);
  TROCAR_TRY(const auto devices_file, find_data("devices.toml"));
  TROCAR_TRY(const auto devices, stylus::load_device_presets(devices_file));
  values["--device"] = names_of(devices, &stylus::DevicePreset::name);
  TROCAR_TRY(const auto views_file, find_data("views.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(views_file));
  values["--view"] = names_of(views, &ultrasound::ProbeView::name);
  TROCAR_TRY(const auto transducers_file, find_data("transducers.toml"));
  TROCAR_TRY(const auto transducers, ultrasound::load_transducers(transducers_file));
  values["--transducer"] = names_of(transducers, &ultrasound::Transducer::name);
  return values;
}

Words values_of(const Option& option, const Values& known) {
  Words names = option.dashed_names();
  names.push_back(option.argument_name());
  for (const std::string& name : names)
    if (const auto found = known.find(name); found != known.end()) return found->second;
  return option.words();
}

std::string quoted(const Words& words) {
  return fmt::format("'{}'", fmt::join(words, " "));
}

/// Script lines of one command and its sub-commands. `path`: "patient build"; empty for the program.
class CommandLines {
 public:
  explicit CommandLines(const Values& known) : known_(known) {}

  void add(const Command& command, const std::string& path) {
    Words words;
    for (const Command& below : command.commands()) {
      const std::string name = path.empty() ? below.name() : path + " " + below.name();
      words.push_back(below.name());
      commands_ += fmt::format("      '{}') command='{}' ;;\n", name, name);
      add(below, name);
    }
    for (const Option& option : command.options()) add(option, path, words);
    words_ += fmt::format("    '{}') words={} ;;\n", path, quoted(words));
  }

  const std::string& commands() const { return commands_; }
  const std::string& words() const { return words_; }
  const std::string& values() const { return values_; }

 private:
  void add(const Option& option, const std::string& path, Words& words) {
    const Words values = values_of(option, known_);
    Words patterns;
    for (const std::string& name : option.dashed_names()) {
      words.push_back(name);
      if (name.starts_with("--")) patterns.push_back(fmt::format("'{} {}'", path, name));
    }
    if (!option.argument_name().empty()) words.insert(words.end(), values.begin(), values.end());
    if (option.is_flag() || patterns.empty()) return;
    values_ += fmt::format("    {}) values={} ;;\n", fmt::join(patterns, "|"), quoted(values));
  }

  const Values& known_;
  std::string commands_, words_, values_;
};

// File names complete wherever no word fits: outputs, folders and sessions are files.
constexpr const char* kScript = R"(# Bash completion of trocar. Load it with: source <(trocar completion bash)
_trocar() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  local command='' word words='' values='none'
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "${{command:+$command }}$word" in
{}    esac
  done
  case "$command $previous" in
{}  esac
  if [[ $values != none ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$current"))
    return
  fi
  case "$command" in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o bashdefault -o default -F _trocar trocar
)";

Status print_completion(const Command& program) {
  TROCAR_TRY(const Values known, known_values());
  CommandLines lines(known);
  lines.add(program, {});
  fmt::print(fmt::runtime(kScript), lines.commands(), lines.values(), lines.words());
  return {};
}

}  // namespace

void add_completion_command(Command& program, Action& action) {
  Command completion = program.add_command("completion", "Print a completion script for a shell");
  completion.require_command();
  completion.footer("Example:\n  source <(trocar completion bash)\n");
  Command bash = completion.add_command("bash", "Commands, options and names for bash");
  bash.footer(
      "Examples:\n  source <(trocar completion bash)\n"
      "  trocar completion bash > ~/.local/share/bash-completion/completions/trocar\n");
  bash.when_parsed([&action, program] { action = [program] { return print_completion(program); }; });
}

}  // namespace trocar::cli
