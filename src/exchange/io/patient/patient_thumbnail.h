#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace trocar::io {

/// File of a patient folder with a small picture of the patient; optional. About 320 x 200 pixels, PNG.
inline constexpr const char* kThumbnailFile = "thumbnail.png";

/// Picture of a patient: `kThumbnailFile` of a patient folder, phantoms/thumbnails/NAME.png of data_dir() for an
/// embedded patient. Empty: there is none. Only the presence of the file is checked, not its content.
std::optional<std::filesystem::path> find_thumbnail(const std::string& folder_or_name);

}  // namespace trocar::io
