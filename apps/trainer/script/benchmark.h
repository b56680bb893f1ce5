#pragma once

#include "script/script.h"

namespace trocar::trainer {

/// The steps behind --benchmark: a guided puncture of the embedded patient, in every layout; frame times are printed
/// for each.
Result<std::vector<ScriptStep>> benchmark_steps();

}  // namespace trocar::trainer
