#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/stack/slice_stack.h"
#include "io/ct_series/detail/dicom_slice.h"
#include "io/image/detail/raw_volume.h"
#include "volume/grid.h"

namespace trocar::io::detail {

/// One series in the order of its slices along their normal.
struct DicomSeries {
  std::vector<DicomSlice> slices;
  dicom::SliceStack stack;  ///< The places of the slices.
  dicom::StackPlan plan;    ///< The grid that they fill.
};

/// Orders slices and plans their grid; the slice step comes from the positions. Errors: no slice or only one, several
/// frames, colour, slices of different size or direction, no position, two slices at one position, a gap above 10 mm or
/// three times the usual distance in an uneven stack, a stack that leans by more than 45 degrees.
Result<DicomSeries> order_slices(std::vector<DicomSlice> slices, const std::filesystem::path& folder);

/// A volume that was read from a folder.
template <class T>
struct DicomVolume {
  volume::Grid<T> grid;
  std::string series_uid;
  std::string frame_of_reference;
  std::string patient_id;             ///< For comparison, never displayed.
  std::vector<Vec3> slices_P;         ///< Centres of the first pixels of the slices in the files, along their normal.
  std::vector<std::string> warnings;  ///< Images left out; a tilted or uneven stack that was resampled; padding.
};

/// What counts as the value of a pixel.
enum class PixelNumbers {
  kRescaled,  ///< By RescaleSlope and RescaleIntercept.
  kStored,
};

/// Reads one DICOM series of a folder and its sub-folders; files that are not DICOM images are ignored. A tilted stack
/// is straightened, an uneven one gets even steps: numbers linearly, bytes by the nearest slice. Padding of a CT
/// (int16) becomes air (fill_padding). `wanted` and `preferred`: see choose_series. Errors: those of find_series,
/// choose_series, leave_out_others, order_slices, check_acquisitions and, for a CT, check_alternation.
template <class T>
Result<DicomVolume<T>> read_dicom_folder(const std::filesystem::path& folder, Converter<T> convert,
                                         const std::string& wanted = {}, const std::vector<std::string>& preferred = {},
                                         PixelNumbers numbers = PixelNumbers::kRescaled);

}  // namespace trocar::io::detail
