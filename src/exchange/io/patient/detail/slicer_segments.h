#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/image/detail/raw_volume.h"
#include "io/patient/label_map.h"
#include "patient_builder/build_patient.h"

namespace trocar::io::detail {

/// The structures of a .seg.nrrd of 3D Slicer, described in its header: Segment{N}_Name, _LabelValue, _Layer, one
/// source a layer. None for an ordinary file. Errors: a segment without a name or value, in a layer that the image does
/// not have, or with another one's value in its layer; misspelt fields; voxels of no segment.
Result<std::vector<patient_builder::LabelSource>> read_slicer_segments(const RawVolume& raw, const LabelMap& map,
                                                                       const std::filesystem::path& path,
                                                                       std::vector<std::string>& warnings);

}  // namespace trocar::io::detail
