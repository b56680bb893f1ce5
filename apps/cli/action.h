#pragma once

#include <functional>

#include "command.h"
#include "core/result.h"

namespace trocar::cli {

using arguments::Command;
using arguments::Option;

/// The requested command, bound to its arguments: set while the command line is parsed, called by main.
using Action = std::function<Status()>;

}  // namespace trocar::cli
