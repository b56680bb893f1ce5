#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/image/detail/raw_volume.h"
#include "io/patient/label_map.h"
#include "patient_builder/build_patient.h"

namespace trocar::io::detail {

/// Where a label file comes from.
enum class Place { kNamedByUser, kInFolder };

/// The structures of a label file: a mask is named after its file, numbers by the label table in the file's own header
/// (an entry of the user's file wins), else by the map. Values without a name are left to build_patient, which lists
/// those of all files. Errors: several values in a file that is named after one structure, unless the user has chosen
/// or written what they mean; no background; a background that has the name of a structure; several values and no map.
Result<patient_builder::LabelSource> name_labels(const RawVolume& raw, const std::filesystem::path& path,
                                                 const LabelMap& map, Place place, std::vector<std::string>& warnings);

}  // namespace trocar::io::detail
