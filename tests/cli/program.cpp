#include "cli/program.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace trocar::cli_test {
namespace fs = std::filesystem;

Outcome trocar(const std::string& arguments, const std::string& before) {
  return run_program("trocar", arguments, before);
}

Outcome run_program(const std::string& program, const std::string& arguments, const std::string& before) {
  const char* folder = std::getenv("TROCAR_BIN_DIR");
  if (folder == nullptr) {
    ADD_FAILURE() << "TROCAR_BIN_DIR is not set: run the test through ctest";
    return {};
  }
  return run_shell(before + " '" + folder + "/" + program + "' " + arguments);
}

Outcome run_shell(const std::string& line) {
  const TemporaryFolder temporary;
  const std::string err_file = temporary / "err";
  Outcome outcome;
  FILE* pipe = popen((line + " 2>'" + err_file + "'").c_str(), "r");
  if (pipe == nullptr) return outcome;
  char buffer[4096];
  for (std::size_t got = 0; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.out.append(buffer, got);
  const int status = pclose(pipe);
  outcome.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  std::ifstream err(err_file, std::ios::binary);
  outcome.err.assign(std::istreambuf_iterator<char>(err), std::istreambuf_iterator<char>());
  return outcome;
}

config::Json json_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  auto json = config::parse_json(outcome.out, "standard output");
  if (json) return *json;
  ADD_FAILURE() << json.error().text() << "\n" << outcome.out;
  return nullptr;
}

void expect_refused(const Outcome& outcome, int exit_status, const std::string& words) {
  EXPECT_EQ(outcome.exit_status, exit_status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

int line_count(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace trocar::cli_test
