#include "cli/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <mutex>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/text.h"

namespace trocar::cli {
namespace fs = std::filesystem;

void print_warning(std::string_view text) {
  fmt::print(stderr, "warning: {}\n", text);
}

namespace {

constexpr std::chrono::seconds kBetweenLines{1};

/// A sum such as 17.208000000000002 is printed as 17.208: the last two digits are those of the arithmetic.
void round_numbers(config::Json& json) {
  if (json.is_structured()) {
    for (config::Json& member : json) round_numbers(member);
  } else if (json.is_number_float()) {
    const double value = json.get<double>();
    json = parse_number<double>(fmt::format("{:.{}g}", value, kJsonDigits)).value_or(value);
  }
}

}  // namespace

void print_json(config::Json json) {
  round_numbers(json);
  fmt::print("{}\n", config::json_text(json));
}

struct ProgressPrinter::State {
  std::mutex mutex;  // several threads can report steps
  bool is_terminal = ::isatty(STDERR_FILENO) == 1;
  std::string step;
  int percent = -1;
  std::chrono::steady_clock::time_point last_line = std::chrono::steady_clock::now();

  void show(std::string_view new_step, double fraction) {
    const std::lock_guard lock(mutex);
    const int new_percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
    if (new_step == step && new_percent == percent) return;
    if (!is_terminal) {  // plain lines, only for long work
      const auto now = std::chrono::steady_clock::now();
      if (now - last_line < kBetweenLines) return;
      last_line = now;
    }
    step = new_step;
    percent = new_percent;
    if (is_terminal) {
      constexpr int kBarWidth = 30;
      fmt::print(stderr, "\r\033[K{:#>{}}{:.>{}} {:3} %  {}", "", percent * kBarWidth / 100, "",
                 kBarWidth - percent * kBarWidth / 100, percent, step);
    } else {
      fmt::print(stderr, "{:3} % {}\n", percent, step);
    }
  }
};

ProgressPrinter::ProgressPrinter() : state_(std::make_unique<State>()) {}

ProgressPrinter::~ProgressPrinter() {
  if (state_->is_terminal && state_->percent >= 0) fmt::print(stderr, "\r\033[K");
}

Progress ProgressPrinter::callback() const {
  return [state = state_.get()](std::string_view step, double fraction) { state->show(step, fraction); };
}

std::string plain_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    line += character && is_printable(character->code_point) ? text.substr(0, bytes) : std::string_view("?");
    text.remove_prefix(bytes);
  }
  return line;
}

Status check_new(const fs::path& out, const char* option) {
  if (out.empty()) return fail_usage(std::string(option) + " is empty", option, "name a file or folder to create");
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(out, ignored)))
    return fail_usage("output already exists", out.string(), "choose another name or delete it");
  return check_can_write(out);
}

Result<fs::path> find_data(std::string_view name) {
  const fs::path folder = data_dir();
  if (folder.empty()) {
    return fail("the data tables of tasks, needles and tissues are missing", "data/",
                "set TROCAR_DATA_DIR to the data folder of Trocar");
  }
  return folder / name;
}

}  // namespace trocar::cli
