#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/result.h"
#include "io/patient/patient_folder.h"
#include "ultrasound/panorama/panorama.h"

namespace trocar::io {

// Files of a patient folder with a panorama: a uint8 volume in its own frame U (LPS mm; 0: never imaged), and X_PU,
// which maps its points to P.
inline constexpr const char* kPanoramaFile = "us/panorama.nrrd";
inline constexpr const char* kPanoramaTransformFile = "us_to_ct.tfm";
inline constexpr const char* kPanoramaLandmarkFile = "us/landmarks.mrk.json";  ///< Optional; places in U.

/// True if the patient is a folder with both files of a panorama; reads none of them.
bool has_panorama(const PatientSource& source);

/// Reads and prepares the panorama of a patient; the volume itself is read only here, because most programs do not use
/// it. The field `trocar_dynamic_range_db` of the volume gives the dynamic range of its gray values; 60 dB without it.
/// Errors: an embedded patient, a missing file (the message names the commands that make it), a damaged or empty
/// volume, a transform that is not rigid, a dynamic range that is no number or not within 20..100.
Result<std::shared_ptr<const ultrasound::Panorama>> load_panorama(const PatientSource& source);

/// File of a patient folder with a small picture of the patient; optional. About 320 x 200 pixels, PNG.
inline constexpr const char* kThumbnailFile = "thumbnail.png";

/// Picture of a patient: `kThumbnailFile` of a patient folder, phantoms/thumbnails/NAME.png of data_dir() for an
/// embedded patient. Empty: there is none. Only the presence of the file is checked, not its content.
std::optional<std::filesystem::path> find_thumbnail(const std::string& folder_or_name);

}  // namespace trocar::io
