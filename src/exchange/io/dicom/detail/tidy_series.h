#pragma once

#include <string>
#include <vector>

#include "io/dicom/detail/find_series.h"

namespace trocar::io::detail {

/// The images of a series that can be slices of its volume. Left out, with a warning: overview images (ImageType
/// LOCALIZER), Secondary Captures among others, a few images of another direction than the rest, and copies: the same
/// instance, or the same pixels at the same place. The others keep their order. Error: one instance twice with
/// different pixels.
Result<SeriesImages> leave_out_others(SeriesImages images, std::vector<std::string>& warnings);

/// True if two images have the same size, spacing and direction, within rounding. Both have a position.
bool is_alike(const DicomSlice& a, const DicomSlice& b);
/// True if the image has position, direction and spacing.
bool has_place(const DicomSlice& slice);
/// Distance along the normal of the slices below which two are at one place.
inline constexpr double kSamePlace_mm = 1e-3;

}  // namespace trocar::io::detail
