#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "io/ct_series/detail/dicom_slice.h"
#include "io/ct_series/dicom_folder.h"
#include "io/image/detail/raw_volume.h"

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

/// Checks slices in the order along their normal: those of one acquisition or time point (DicomSlice::acquisition) lie
/// together, as in a scan in steps. Error: they alternate with those of another one, as phases of a contrast agent or
/// of the breath do when their places lie between each other. A single slice that was scanned again is no error.
Status check_acquisitions(const std::vector<DicomSlice>& slices, const std::filesystem::path& folder);

/// The same by the pixels, for series that do not number their acquisitions: every slice resembles the next but one
/// more than the next. `hu` has the pixels of all slices, `pixels` of each.
Status check_alternation(std::span<const std::int16_t> hu, std::size_t pixels, const std::filesystem::path& folder);

inline constexpr double kPaddingAir_hu = -1024.0;  ///< What lies beyond the field of view.

/// Pixels that were found to be padding.
struct PaddingCount {
  std::size_t filled = 0;  ///< Became air.
  std::size_t kept = 0;    ///< Have a number of padding that can be a tissue's, and lie within the image.
};

/// Makes the padding of a slice air (PixelPaddingValue, PixelPaddingRangeLimit; PS3.3, C.7.5.1.1.2): the number for
/// -1024 HU, or the next one that can be stored. Padding of up to -1024 HU is air already. If its HU can be a tissue's,
/// only what reaches the edge of the slice through such pixels is padding. `pixels` are the voxels.bytes, which are not
/// read.
PaddingCount fill_padding(const RawVoxels& voxels, const DicomSlice& slice, std::span<std::byte> pixels);

/// HU of the padding if it would not be air without fill_padding().
std::optional<double> padding_hu(const DicomSlice& slice);

}  // namespace trocar::io::detail
