#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/result.h"
#include "geometry/vec.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {

/// What the header of one DICOM image says. Frame P is DICOM's own: LPS, mm.
struct DicomSlice {
  std::filesystem::path file;
  std::string series_uid;
  std::string series_description;
  std::string modality;            ///< "CT", "MR" …; empty where the file has none.
  std::string patient_id;          ///< Compared among slices, never shown.
  std::string frame_of_reference;  ///< UID; slices of another frame lie elsewhere.
  int columns = 0;
  int rows = 0;
  int frames = 1;
  int samples_per_pixel = 1;
  std::optional<Vec3> position_P;                   ///< Centre of the first pixel.
  std::optional<std::array<Vec3, 2>> directions_P;  ///< Along a row (growing column), along a column.
  std::optional<std::array<double, 2>> spacing_mm;  ///< Between columns, between rows.
  std::size_t declared_bytes = 0;                   ///< Of the unpacked pixels.
  bool is_cut = false;                              ///< Pixels that are not compressed, and fewer than declared.
  double slope = 1.0;
  double intercept = 0.0;
};

/// Header of a DICOM image with or without the "DICM" mark; nothing where the file is no DICOM or has no image. An
/// error where it is a DICOM file, but damaged or cut.
Result<std::optional<DicomSlice>> find_dicom_slice(const std::filesystem::path& path);

/// Unpacks the pixels of one slice (uncompressed, JPEG, JPEG-LS, JPEG 2000, RLE) and hands them to `use`.
Status decode_slice(const DicomSlice& slice, const std::function<Status(const RawVoxels&)>& use);

}  // namespace trocar::io::detail
