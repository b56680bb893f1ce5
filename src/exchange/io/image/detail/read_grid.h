#pragma once

#include <filesystem>

#include "core/result.h"
#include "io/ct_series/detail/dicom_series.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"

namespace trocar::io::detail {

/// Checks that a path names an image file or a folder; a single DICOM file is an error with advice.
Status check_image_path(const std::filesystem::path& path);

/// Reads any supported image: a file or the folder of a DICOM series; appends what the file says about itself.
template <class T>
Result<volume::Grid<T>> read_grid(const std::filesystem::path& path, Converter<T> convert,
                                  std::vector<std::string>& warnings) {
  TROCAR_TRY_STATUS(check_image_path(path));
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    TROCAR_TRY(DicomVolume<T> volume, read_dicom_folder<T>(path, convert));
    warnings.insert(warnings.end(), volume.warnings.begin(), volume.warnings.end());
    return std::move(volume.grid);
  }
  TROCAR_TRY(const RawVolume raw, read_volume_file(path));
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  return to_grid<T>(raw, path.string(), convert);
}

}  // namespace trocar::io::detail
