#include "bench/real_data.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "core/files/file_system.h"
#include "core/files/folders.h"

extern char** environ;

namespace trocar::bench {
namespace fs = std::filesystem;

fs::path real_data() {
  const char* named = std::getenv("TROCAR_TEST_DATA");
  return named != nullptr ? fs::path(named) : data_dir() / ".." / ".." / "shared" / "data";
}

Status run_quietly(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, argv.front(), &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  // A shell's command begins with the program.
  const std::string program =
      arguments.front() == "sh" ? arguments.back().substr(0, arguments.back().find(' ')) : arguments.front();
  constexpr int kNotFound = 127;
  const bool has_ended = failed == 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status);
  if (failed == ENOENT || (has_ended && WEXITSTATUS(status) == kNotFound))
    return fail("a program that the benchmark compares with is missing", program, "install it: apt install " + program);
  if (!has_ended || WEXITSTATUS(status) != 0) return fail("the program failed", program, "run it by hand to see why");
  return {};
}

Status run_trocar(std::vector<std::string> arguments) {
  const auto trocar = find_program("trocar");
  if (!trocar) return fail("the program trocar is missing", "beside trocar-bench", "build it with scripts/build");
  arguments.insert(arguments.begin(), trocar->string());
  return run_quietly(arguments);
}

}  // namespace trocar::bench
