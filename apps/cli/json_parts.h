#pragma once

#include "config/json.h"
#include "geometry/pose.h"
#include "learning/history.h"

namespace trocar::cli {

using config::or_null;

config::Json vector_json(const Vec3& v);

/// Which attempts count, and why the others do not.
config::Json counts_json(const learning::AttemptCounts& counts);

}  // namespace trocar::cli
