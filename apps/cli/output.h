#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "config/json.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::cli {

/// What the command line asks for, bound to its arguments: set while it is parsed, called by main.
using Action = std::function<Status()>;

void print_warning(std::string_view text);
/// Results go to standard output, as one JSON object.
void print_json(const config::Json& json);

/// Progress of long work on standard error: a bar on a terminal, one plain line a step otherwise.
class ProgressPrinter {
 public:
  ProgressPrinter();
  ~ProgressPrinter();  ///< Leaves a clean line.
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  Progress callback() const;  ///< Valid while the printer lives.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Before long work: `out` is not empty, nothing lies there yet (exit status 2 both), and it can be written.
Status check_new(const std::filesystem::path& out, const char* option = "--out");

/// A shipped table: "tasks", "needles.toml". An error where the data folder is missing.
Result<std::filesystem::path> find_data(std::string_view name);

}  // namespace trocar::cli
