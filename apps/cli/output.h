#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "config/json_fwd.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::cli {

void print_warning(std::string_view text);
/// Prints results to standard output, as one JSON object. Numbers have kJsonDigits significant digits, without zeros at
/// the end.
inline constexpr int kJsonDigits = 13;
void print_json(config::Json json);

/// A text of a file or a database for a terminal: in one line, without characters that control it or change the order
/// of others.
std::string plain_line(std::string_view text);

/// Prints progress of a long task to standard error: a bar on a terminal, else one plain line per step.
class ProgressPrinter {
 public:
  ProgressPrinter();
  ~ProgressPrinter();  ///< Clears the bar's line.
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  Progress callback() const;  ///< Valid during the lifetime of the printer.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Call before a long task. Errors: `out` is empty or exists (exit status 2 for both), or it cannot be written.
Status check_new(const std::filesystem::path& out, const char* option = "--out");

/// Path of a shipped table: "tasks", "needles.toml". Error: the data folder is missing.
Result<std::filesystem::path> find_data(std::string_view name);

}  // namespace trocar::cli
