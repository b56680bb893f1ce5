#pragma once

#include <string>

#include "core/result.h"

namespace trocar::cli {

/// Whether standard input is a terminal.
bool is_terminal();

/// Reads a line from the terminal after a prompt on standard error, without showing what is typed. The terminal shows
/// it again afterwards, also after Ctrl+C or another signal, which is an error, and the end of the input.
Result<std::string> read_secret_line(const char* prompt);

/// Reads a line from standard input that is no terminal.
Result<std::string> read_piped_line();

}  // namespace trocar::cli
