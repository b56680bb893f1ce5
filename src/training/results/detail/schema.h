#pragma once

#include <span>

#include "database/statements.h"

namespace trocar::results::detail {

/// The schema of the results, version by version. Never change a step that was released: add one.
std::span<const database::Migration> migrations();

}  // namespace trocar::results::detail
