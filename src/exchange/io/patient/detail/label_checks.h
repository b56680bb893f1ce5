#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "io/patient/label_map.h"
#include "patient_builder/build_patient.h"
#include "volume/grid.h"

namespace trocar::io::detail {

/// Ignores the structures that no task needs (LabelMap::is_unused), with one warning that names them.
void leave_out_unused(std::vector<patient_builder::LabelSource>& sources, const LabelMap& map,
                      std::vector<std::string>& warnings);

/// Counts the voxels of each structure in its file and on the CT's grid (`ct` without voxels: unknown). Empty
/// structures are removed with a warning: each of a file that describes itself; the empty masks in one line. Warnings:
/// a structure that loses more than 1 ml beyond the CT or on its coarser voxels, or all of its voxels. Errors (at
/// `where`): no structure has a voxel, or none within the CT.
Status check_voxels(std::vector<patient_builder::LabelSource>& sources, const LabelMap& map,
                    const volume::GridGeometry& ct, const std::string& where, std::vector<std::string>& warnings);

}  // namespace trocar::io::detail
