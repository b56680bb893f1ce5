#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/segmentation.h"
#include "geometry/vec.h"

namespace trocar::dicom::detail {

inline constexpr const char* kExportSegmentationAgain =
    "export the segmentation again, or save it as .seg.nrrd or .nii.gz";

enum class SegmentationType { kBinary, kFractional, kLabelMap };

/// One frame of a SEG.
struct SegFrame {
  int segment = 0;  ///< Number of its segment; 0 in a label map.
  Vec3 origin_P = Vec3::Zero();
};

/// A SEG without its pixels (DICOM PS3.3, A.51 and C.8.20).
struct SegHeader {
  SegmentationType type = SegmentationType::kBinary;
  int columns = 0;
  int rows = 0;
  int bits = 1;                   ///< Of a pixel: 1, 8 or 16.
  int maximum_fractional = 255;   ///< Value of "all inside" in a fractional SEG.
  Vec3 row_P = Vec3::UnitX();     ///< Along a row, unit vector.
  Vec3 column_P = Vec3::UnitY();  ///< Along a column.
  double column_step_mm = 1.0;
  double row_step_mm = 1.0;
  std::optional<double> slice_step_mm;  ///< SpacingBetweenSlices, if all frames have the same.
  std::optional<double> thickness_mm;   ///< SliceThickness, likewise.
  std::vector<Segment> segments;        ///< Without the background of a label map.
  std::vector<SegFrame> frames;
  std::optional<int> padding;  ///< PixelPaddingValue: another background of a label map.
};

/// Errors (at `where`): no segments, frames without a place, in several directions, of several
/// pixel spacings or of a segment that is not defined, an unknown kind of pixels.
Result<SegHeader> read_seg_header(const DicomFile& file, const std::string& where);

}  // namespace trocar::dicom::detail
