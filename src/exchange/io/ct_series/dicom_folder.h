#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/ct_series/detail/dicom_slice.h"

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

namespace trocar::io::detail {

/// The images of one series, ordered by file; at least one.
using SeriesImages = std::vector<DicomSlice>;

/// Depth of sub-folders; DICOM media have four levels (patient, study, series, image).
inline constexpr int kMaxFolderDepth = 16;

/// The regular files in a folder and its sub-folders, sorted. Symbolic links to folders are not followed, sub-folders
/// without permission are skipped. Errors: as list_tree().
Result<std::vector<std::filesystem::path>> files_below(const std::filesystem::path& folder,
                                                       int most_depth = kMaxFolderDepth);

/// True if a folder contains at least one DICOM image, even a damaged one; its sub-folders are not searched.
bool has_dicom_images(const std::filesystem::path& folder);

/// The series with images in a folder and its sub-folders, in the order of their first files. Files that are not DICOM
/// images are ignored; symbolic links to folders are not followed. Errors: a damaged DICOM file, no image at all; a
/// file that has the name of a slice, but is empty or no DICOM file.
Result<std::vector<SeriesImages>> find_series(const std::filesystem::path& folder);

/// Selects one of several series. `wanted`: its number (from 1) or its UID. If empty: the only series, else the only CT
/// volume among those with a UID in `preferred` (which the labels refer to), else the only CT volume: a series with at
/// least two slices that are no overview images. The error (exit status 2) lists the series.
Result<SeriesImages> choose_series(std::vector<SeriesImages> series, const std::filesystem::path& folder,
                                   const std::string& wanted, const std::vector<std::string>& preferred = {});

}  // namespace trocar::io::detail
