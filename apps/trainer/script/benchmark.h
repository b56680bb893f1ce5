#pragma once

#include <string>
#include <vector>

#include "script/script.h"

namespace trocar::trainer {

/// The steps of --benchmark: a guided puncture of the embedded patient in these layouts, in every one if `layouts` is
/// empty; frame times are printed for each. Errors: no layout of this name.
Result<std::vector<ScriptStep>> benchmark_steps(const std::vector<std::string>& layouts = {});

}  // namespace trocar::trainer
