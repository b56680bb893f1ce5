#pragma once

#include "results/notes.h"
#include "web/api/json_fields.h"

namespace trocar::web {

/// An attempt as lists show it.
Json attempt_json(const results::Attempt& attempt);
Json note_json(const results::Note& note);
/// Path and forces; frame P (LPS, mm).
Json trace_json(const results::Trace& trace);

}  // namespace trocar::web
