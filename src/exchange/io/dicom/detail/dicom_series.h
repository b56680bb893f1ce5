#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/dicom/detail/dicom_slice.h"
#include "io/image/detail/raw_volume.h"
#include "volume/grid.h"

namespace trocar::io::detail {

/// One series in the order of its slices along their normal.
struct DicomSeries {
  volume::GridGeometry geometry;
  std::vector<DicomSlice> slices;  ///< k = 0, 1, 2 …
};

/// Orders slices and computes their geometry; the slice step comes from the positions. Errors: no slice or only one,
/// several frames, colour, slices of different size or direction, no position, two slices at one position, uneven
/// steps, gantry tilt (the stack deviates by more than 0.3 degrees from the slices' normal).
Result<DicomSeries> order_slices(std::vector<DicomSlice> slices, const std::filesystem::path& folder);

/// Reads one DICOM series of a folder and its sub-folders; files that are not DICOM images are ignored. `wanted`: see
/// choose_series.
template <class T>
Result<volume::Grid<T>> read_dicom_folder(const std::filesystem::path& folder, Converter<T> convert,
                                          const std::string& wanted = {});

}  // namespace trocar::io::detail
