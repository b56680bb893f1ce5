#pragma once

#include "core/random.h"
#include "geometry/vec.h"

namespace trocar::testing {

/// Each coordinate is uniform from -size to size.
inline Vec3 random_vec(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

}  // namespace trocar::testing
