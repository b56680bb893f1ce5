#pragma once

#include <nlohmann/json_fwd.hpp>

namespace trocar::config {

/// A JSON value whose objects keep the order of their keys. Enough to declare functions; "config/json.h" is for their
/// bodies.
using Json = nlohmann::ordered_json;

}  // namespace trocar::config
