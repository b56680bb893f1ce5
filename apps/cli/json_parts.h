#pragma once

#include <optional>

#include "config/json.h"
#include "geometry/pose.h"
#include "learning/history.h"

namespace trocar::cli {

config::Json vector_json(const Vec3& v);

template <class Value>
config::Json or_null(const std::optional<Value>& value) {
  return value ? config::Json(*value) : config::Json(nullptr);
}

/// Which attempts count, and why the others do not.
config::Json counts_json(const learning::AttemptCounts& counts);

}  // namespace trocar::cli
