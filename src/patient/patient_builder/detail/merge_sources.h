#pragma once

#include <string>
#include <vector>

#include "anatomy/known_structures.h"
#include "patient_builder/build_patient.h"

namespace trocar::patient_builder::detail {

/// The structures of all sources on one grid.
struct MergedLabels {
  volume::LabelGrid labels;
  anatomy::LabelTable table;   ///< Ids in file order, from 1.
  volume::MaskGrid body_hint;  ///< A mask of the whole body ("skin"), where a source has one; else empty.
};

/// Resamples the sources onto the grid of the CT (nearest voxel); a voxel in two structures gets the one of higher
/// priority, the smaller one among equals; overlaps above 1 ml are warnings. Each source is freed after use. Errors and
/// warnings as build_patient.
Result<MergedLabels> merge_sources(std::vector<LabelSource> sources, const volume::GridGeometry& grid,
                                   const anatomy::KnownStructures& known, std::vector<std::string>& warnings);

}  // namespace trocar::patient_builder::detail
