// trocar bench: the kernels' benchmarks, which are a program of their own.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "cli/bench_arguments.h"
#include "cli/commands.h"
#include "core/files/file_system.h"

namespace trocar::cli {
namespace {

constexpr const char* kBench = "bench";
constexpr const char* kBenchProgram = "trocar-bench";

/// Replaces this program by trocar-bench, with the same arguments.
Status start_bench_program(std::vector<std::string> words) {
  const auto program = find_program(kBenchProgram);
  if (!program) {
    std::error_code ignored;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    return fail(std::string(kBenchProgram) + " is missing", folder.string() + ", $TROCAR_BIN_DIR, $PATH",
                "it is in no package: build it from the sources with scripts/build release trocar-bench");
  }
  words.front() = program->string();
  words.erase(std::find(words.begin(), words.end(), kBench));
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(argv.front(), argv.data());
  return fail(std::string("cannot start trocar-bench: ") + std::strerror(errno), words.front(), "build it again");
}

}  // namespace

void add_bench_command(Command& program, Action& action, std::vector<std::string> words) {
  Command command = program.add_command(
      kBench, "Measure speed, forces, energy and images, beside comparable libraries where they are installed");
  const auto arguments = std::make_shared<BenchArguments>();  // read twice: here for the help and the usage errors
  add_bench_options(command, *arguments);
  command.when_parsed(
      [&action, arguments, words = std::move(words)] { action = [words] { return start_bench_program(words); }; });
}

}  // namespace trocar::cli
