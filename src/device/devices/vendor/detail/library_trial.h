#pragma once

#include <chrono>
#include <string>

#include "core/result.h"

namespace trocar::devices::detail {

/// Loads a shared library in a child process first, because its constructors run code of another vendor: the child is
/// killed if they take longer than `timeout`, and its end does not end this program. `library`: as for dlopen().
/// A library that is loaded already, or that the loader does not find, passes. Errors: loading takes too long or ends
/// the child; no child can start.
Status try_library(const std::string& library, std::chrono::milliseconds timeout);

}  // namespace trocar::devices::detail
