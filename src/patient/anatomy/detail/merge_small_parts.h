#pragma once

#include <cstdint>
#include <span>

#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// Connected parts (6 neighbours) of the labels `ids` smaller than `min_voxels` take that label out of `ids` whose
/// large parts they touch most; a part that touches none stays.
void merge_small_parts(volume::LabelGrid& labels, std::span<const std::uint8_t> ids, std::size_t min_voxels);

}  // namespace trocar::anatomy::detail
