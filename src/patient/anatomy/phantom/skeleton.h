#pragma once

#include <optional>

#include "anatomy/phantom/phantom_data.h"
#include "anatomy/phantom/torso.h"

namespace trocar::anatomy::phantom {

/// The rib above the intercostal space at a place of the chest wall; empty without ribs on both sides.
std::optional<int> intercostal_space(const AbdomenData& data, const Place& place);

}  // namespace trocar::anatomy::phantom
