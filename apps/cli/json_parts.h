#pragma once

#include <optional>

#include "config/json.h"
#include "geometry/pose.h"

namespace trocar::cli {

config::Json vector_json(const Vec3& v);

template <class Value>
config::Json or_null(const std::optional<Value>& value) {
  return value ? config::Json(*value) : config::Json(nullptr);
}

}  // namespace trocar::cli
