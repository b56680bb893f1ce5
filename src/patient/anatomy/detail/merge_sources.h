#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "anatomy/known_structures.h"

namespace trocar::anatomy::detail {

/// The structures of all sources on one grid.
struct MergedLabels {
  volume::LabelGrid labels;
  LabelTable table;            ///< Ids in file order, from 1.
  volume::MaskGrid body_hint;  ///< A mask of the whole body ("skin"), where a source has one; else empty.
};

/// Resamples the sources onto the grid of the CT (nearest voxel); where two claim a voxel the structure of higher
/// priority has it, the earlier one among equals. Sources are freed as they are used. Errors and warnings as
/// build_patient.
Result<MergedLabels> merge_sources(std::vector<LabelSource> sources, const volume::GridGeometry& grid,
                                   const KnownStructures& known, std::vector<std::string>& warnings);

}  // namespace trocar::anatomy::detail
