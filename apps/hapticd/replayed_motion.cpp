#include "replayed_motion.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "core/files/file_system.h"
#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"

namespace trocar {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kSessionStart = "SQLite format 3";

Result<bool> is_session(const fs::path& path) {
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kSession));
  std::array<char, kSessionStart.size()> start{};
  std::ifstream(file.pinned_path(), std::ios::binary).read(start.data(), start.size());
  return std::string_view(start.data(), start.size()) == kSessionStart;
}

/// Runs a program with its standard error in a file; its exit status, or -1.
int run_program(const fs::path& program, std::vector<std::string> arguments, const fs::path& errors) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, errors.c_str(), O_CREAT | O_WRONLY, 0600);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, program.c_str(), &streams, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&streams);
  int status = 0;
  if (failed != 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

/// The message of a failed program, without its "error: ".
std::string message_in(const fs::path& errors) {
  std::string text = read_file(errors).value_or("");
  constexpr std::string_view kPrefix = "error: ";
  if (text.starts_with(kPrefix)) text.erase(0, kPrefix.size());
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

}  // namespace

Result<devices::RecordedMotion> load_motion(const fs::path& path) {
  TROCAR_TRY(const bool has_session, is_session(path));
  if (!has_session) return devices::read_motion(path);
  const auto trocar = find_program("trocar");
  if (!trocar)
    return fail("the program trocar, which reads sessions, was not found", path.string(),
                "give a file of trocar session motion");
  const TemporaryFolder folder;
  const fs::path motion = folder / "motion.csv", errors = folder / "errors.txt";
  const int status = run_program(*trocar, {"session", "motion", path.string(), "--csv", motion.string()}, errors);
  if (status == 0) {
    fmt::print(stderr, "{}", read_file(errors).value_or(""));  // its warnings
    return devices::read_motion(motion);
  }
  return fail(fmt::format("trocar cannot read the session ({})", message_in(errors)), path.string(),
              "give another session, or a file of trocar session motion");
}

}  // namespace trocar
