#pragma once

#include <functional>

#include "core/result.h"

namespace trocar::arguments {

/// Prints "error: what — where — what to do" on standard error; returns the exit status.
int report_error(const Error& error);

/// Runs a program and returns its exit status. Converts exceptions of libraries to an error line. Flushes standard
/// output at the end: if that fails (full disk), a status of 0 becomes 1.
int run_program(const std::function<int()>& program, const char* name);

}  // namespace trocar::arguments
