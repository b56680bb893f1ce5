#include "io/patient/patient_thumbnail.h"

#include "core/files/data_dir.h"
#include "io/patient/patient_source.h"

namespace trocar::io {
namespace fs = std::filesystem;

std::optional<fs::path> find_thumbnail(const std::string& folder_or_name) {
  const fs::path file = is_path(folder_or_name) ? fs::path(folder_or_name) / kThumbnailFile
                                                : data_dir() / "phantoms" / "thumbnails" / (folder_or_name + ".png");
  std::error_code ignored;
  if (folder_or_name.empty() || !fs::is_regular_file(file, ignored)) return std::nullopt;
  return file;
}

}  // namespace trocar::io
