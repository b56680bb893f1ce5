#pragma once

#include <filesystem>
#include <string>

#include "config/json.h"
#include "core/files/folders.h"

namespace trocar::cli_test {

/// Result of a run of the real program.
struct Outcome {
  int exit_status = -1;  ///< 128 + signal if it was killed.
  std::string out;
  std::string err;
};

/// Runs `trocar ARGUMENTS` (a shell line); `before` is a prefix of the line ("env -u DISPLAY").
Outcome trocar(const std::string& arguments, const std::string& before = {});

/// The same for another program of the build: trocar-hapticd.
Outcome run_program(const std::string& program, const std::string& arguments, const std::string& before = {});

/// Runs a line of the shell.
Outcome run_shell(const std::string& line);

/// Standard output as JSON; a test failure and null if it is not JSON.
config::Json json_of(const Outcome& outcome);

/// Expects this exit status, nothing on standard output, and one line "error: ..." that contains `words`.
void expect_refused(const Outcome& outcome, int exit_status, const std::string& words);

int line_count(const std::string& text);
/// A file's text; empty if it cannot be read.
std::string read_text(const std::string& file);

/// A temporary folder, removed by the destructor, that returns the paths of its files as text for command lines.
class TemporaryFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }
  bool is_empty() const { return folder_.is_empty(); }

 private:
  trocar::TemporaryFolder folder_;
};

}  // namespace trocar::cli_test
