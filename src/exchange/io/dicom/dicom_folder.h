#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::io {

/// A DICOM series in a folder or its sub-folders.
struct DicomSeriesInfo {
  std::string uid;
  std::string description;
  std::string modality;    ///< "CT", "MR", "SEG".
  std::size_t images = 0;  ///< Number of images with pixels.
  int columns = 0;         ///< Pixels of the first image.
  int rows = 0;
  std::filesystem::path folder;  ///< Folder of its first file.
};

/// The series with images, in the order of their numbers (the first is number 1, see read_ct). Errors: no folder, no
/// DICOM image, a damaged DICOM file.
Result<std::vector<DicomSeriesInfo>> list_dicom_series(const std::filesystem::path& folder);

}  // namespace trocar::io
