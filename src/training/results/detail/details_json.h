#pragma once

#include <string>
#include <string_view>

#include "results/attempt.h"

namespace trocar::results::detail {

/// Verdict: not_scored, fails and hints of an attempt as one JSON object. Trace: lengths in 0.01 mm, forces in mN and
/// times in ms as integers, which is a quarter of the size of decimal fractions.
std::string verdict_json(const AttemptRecord& record);
std::string trace_json(const Trace& trace);
/// Error: the text is not what the functions above write.
Status read_verdict(std::string_view text, AttemptRecord& record);
Result<Trace> read_trace(std::string_view text);

}  // namespace trocar::results::detail
