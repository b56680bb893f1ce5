#pragma once

#include <optional>

#include "anatomy/phantom/torso.h"

namespace trocar::anatomy::phantom {

/// Height (z, mm) of the centre of a vertebral body; level 0 is T5, 7 is T12, 12 is L5.
float vertebra_height(int level);
/// y of the centre of the vertebral bodies at a height.
float spine_y(float z);
/// The rib above the intercostal space at a place of the chest wall; nothing where there are not ribs on both sides.
std::optional<int> intercostal_space(const Place& place);

}  // namespace trocar::anatomy::phantom
