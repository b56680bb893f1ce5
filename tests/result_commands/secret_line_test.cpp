// Passwords and PINs that are typed on a terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <vector>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

/// `trocar ARGUMENTS...` on a terminal of its own.
class OnTerminal {
 public:
  explicit OnTerminal(std::vector<std::string> arguments) : terminal_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(terminal_);
    ::unlockpt(terminal_);
    const std::string name = ::ptsname(terminal_);
    device_ = ::open(name.c_str(), O_RDWR | O_NOCTTY);  // keeps the terminal's settings after the program's end
    process_ = ::fork();
    if (process_ != 0) return;
    ::setsid();
    const int side = ::open(name.c_str(), O_RDWR);
    ::ioctl(side, TIOCSCTTY, 0);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(side, standard);
    const std::string program = std::string(std::getenv("TROCAR_BIN_DIR")) + "/trocar";
    std::vector<char*> all{const_cast<char*>(program.c_str())};
    for (std::string& argument : arguments) all.push_back(argument.data());
    all.push_back(nullptr);
    ::execv(all.front(), all.data());
    ::_exit(127);
  }
  ~OnTerminal() {
    if (process_ > 0) ::kill(process_, SIGKILL), ::waitpid(process_, nullptr, 0);
    ::close(device_);
    ::close(terminal_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  /// False: the program does not show the text within a long time.
  bool wait_for(const std::string& text) {
    constexpr int kLong_ms = 30'000;
    pollfd output{terminal_, POLLIN, 0};
    while (shown_.find(text) == std::string::npos) {
      char bytes[256];
      if (::poll(&output, 1, kLong_ms) <= 0) return false;
      const ssize_t got = ::read(terminal_, bytes, sizeof(bytes));
      if (got <= 0) return false;
      shown_.append(bytes, static_cast<std::size_t>(got));
    }
    shown_.erase(0, shown_.find(text) + text.size());
    return true;
  }
  void type(const std::string& text) { EXPECT_EQ(::write(terminal_, text.data(), text.size()), ssize_t(text.size())); }
  bool shows_typing() const {
    termios settings{};
    return ::tcgetattr(device_, &settings) == 0 && (settings.c_lflag & ECHO) != 0;
  }
  int exit_status() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  int terminal_, device_ = -1;
  pid_t process_ = 0;
  std::string shown_;
};

TEST(SecretLine, IsHiddenAndRestoresTheTerminal) {
  const TemporaryFolder folder;
  OnTerminal program({"serve", "account", "add", "Eva", "--db", folder / "a.sqlite"});
  ASSERT_TRUE(program.wait_for("characters): "));
  EXPECT_FALSE(program.shows_typing());
  program.type("seven quiet otters\n");
  ASSERT_TRUE(program.wait_for("Again: "));
  program.type("seven quiet otters\n");
  ASSERT_TRUE(program.wait_for("Eva may log in"));
  EXPECT_EQ(program.exit_status(), 0);
  EXPECT_TRUE(program.shows_typing());
}

TEST(SecretLine, RestoresTheTerminalAfterASignal) {
  const TemporaryFolder folder;
  ASSERT_EQ(trocar("results --db '" + (folder / "a.sqlite") + "' add Anna").exit_status, 0);
  const std::vector<std::vector<std::string>> commands{{"serve", "account", "add", "Eva", "--db", folder / "a.sqlite"},
                                                       {"results", "--db", folder / "a.sqlite", "pin", "Anna"}};
  for (const auto& command : commands) {
    OnTerminal program(command);
    ASSERT_TRUE(program.wait_for("): "));
    EXPECT_FALSE(program.shows_typing());
    program.type("\x03");
    EXPECT_TRUE(program.wait_for("interrupted"));
    EXPECT_EQ(program.exit_status(), 1);
    EXPECT_TRUE(program.shows_typing()) << command.front();
  }
}

}  // namespace
}  // namespace trocar::cli_test
