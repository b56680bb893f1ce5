#pragma once

#include <filesystem>

#include "core/result.h"
#include "io/dicom/detail/dicom_series.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"

namespace trocar::io::detail {

/// Checks that a path names an image file or a folder; a single DICOM file is an error with advice.
Status check_image_path(const std::filesystem::path& path);

/// Reads any supported image: a file or the folder of a DICOM series.
template <class T>
Result<volume::Grid<T>> read_grid(const std::filesystem::path& path, Converter<T> convert) {
  TROCAR_TRY_STATUS(check_image_path(path));
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    TROCAR_TRY(DicomVolume<T> volume, read_dicom_folder<T>(path, convert));
    return std::move(volume.grid);
  }
  TROCAR_TRY(const RawVolume raw, read_volume_file(path));
  return to_grid<T>(raw, path.string(), convert);
}

}  // namespace trocar::io::detail
