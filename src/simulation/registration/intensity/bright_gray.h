#pragma once

#include "volume/grid.h"

namespace trocar::registration {

/// Gray level to show white: 99.5 % of the levels above 0 are lower; at least 32. 255 for an empty volume.
double bright_gray(const volume::LabelGrid& gray);

}  // namespace trocar::registration
