#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/segmentation.h"
#include "geometry/vec.h"

namespace trocar::dicom::detail {

/// Points of a closed planar contour in P (mm); the last is joined with the first.
using Contour = std::vector<Vec3>;

/// One structure of an RT structure set (DICOM PS3.3, C.8.8.5 and C.8.8.6).
struct ContourStructure {
  Segment segment;
  std::vector<Contour> contours;
  std::size_t degenerate = 0;        ///< Contours of one or two points, which enclose nothing.
  std::string frame_of_reference{};  ///< UID; empty if the file tells none.
  bool is_exclusive_or = false;      ///< CLOSEDPLANAR_XOR: what two contours of a plane have in common is outside.
};

/// The wanted structures, in the order of their names in the file. Errors (at `where`): no structures, structures
/// without a number or with the same one, contours of a number that no structure has, damaged points;
/// one line that names all structures with open contours or points: OPEN_PLANAR, OPEN_NONPLANAR, POINT, and contours
/// whose ends are more than 10 mm and ten times their longest step apart, whatever their type says.
Result<std::vector<ContourStructure>> read_contours(const DicomFile& file, const std::string& where,
                                                    const std::function<bool(const Segment&)>& is_wanted);

}  // namespace trocar::dicom::detail
