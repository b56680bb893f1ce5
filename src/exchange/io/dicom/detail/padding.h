#pragma once

#include <cstddef>
#include <span>

#include "io/dicom/detail/dicom_slice.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {

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
