#pragma once

#include <cstdint>
#include <span>

#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// Relabels connected parts (6 neighbours) of the labels `ids` that are smaller than `min_voxels`. Each part gets that
/// label of `ids` whose large parts it touches most; a part that touches none stays.
void merge_small_parts(volume::LabelGrid& labels, std::span<const std::uint8_t> ids, std::size_t min_voxels);

}  // namespace trocar::anatomy::detail
