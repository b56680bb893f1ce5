#include "cli/secret_line.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <iostream>

#include "core/interruption.h"

namespace trocar::cli {
namespace {

constexpr const char* kInput = "standard input";
constexpr std::size_t kMostBytes = 4096;

/// Typing is not shown during the lifetime of an object.
class HiddenTyping {
 public:
  HiddenTyping() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios hidden = before_;
    hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    is_hidden_ = ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &hidden) == 0;
  }
  ~HiddenTyping() {
    if (is_hidden_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  }
  HiddenTyping(const HiddenTyping&) = delete;
  HiddenTyping& operator=(const HiddenTyping&) = delete;

 private:
  termios before_{};
  bool is_hidden_ = false;
};

/// Waits for a line, but not through a signal.
Result<std::string> read_terminal() {
  std::string line;
  while (!line.ends_with('\n')) {
    if (is_interrupted()) return tl::unexpected(interruption_error(kInput));
    constexpr int kPoll_ms = 100;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kPoll_ms) <= 0) continue;
    std::array<char, kMostBytes> bytes{};
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return fail("nothing was typed", kInput, "type it");
    line.append(bytes.data(), static_cast<std::size_t>(got));
    if (line.size() > kMostBytes) return fail_usage("the line is too long", kInput, "type a shorter one");
  }
  line.pop_back();
  return line;
}

}  // namespace

bool is_terminal() {
  return ::isatty(STDIN_FILENO) != 0;
}

Result<std::string> read_secret_line(const char* prompt) {
  const InterruptibleWork work;
  const HiddenTyping hidden;
  std::cerr << prompt << std::flush;
  Result<std::string> line = read_terminal();
  std::cerr << "\n";
  return line;
}

Result<std::string> read_piped_line() {
  std::string line;
  if (!std::getline(std::cin, line)) return fail("there is no line to read", kInput, "write it there");
  if (line.size() > kMostBytes) return fail_usage("the line is too long", kInput, "use a shorter one");
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

}  // namespace trocar::cli
