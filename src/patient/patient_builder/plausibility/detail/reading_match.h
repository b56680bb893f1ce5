#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/known_structures.h"
#include "geometry/vec.h"
#include "image/image.h"
#include "volume/grid.h"

namespace trocar::patient_builder::detail {

/// What the CT shows in the voxels of one value of a segmentation.
struct ValueInCt {
  double ml = 0.0;
  double mean_hu = 0.0;
  Vec3 middle_P = Vec3::Zero();  ///< Mean place, mm.
  double spread_x_mm = 0.0;      ///< Standard deviation of the places from left to right.
};

/// All values of a segmentation in a CT, and the middle of what is no air (x and y; the table counts).
struct ValuesInCt {
  std::map<int, ValueInCt> values;
  Vec3 body_middle_P = Vec3::Zero();
};

/// Values below 1 ml and voxels outside of the CT are left out. Looks at a part of the voxels of a large volume.
ValuesInCt measure_values(const volume::CtGrid& ct, const volume::LabelGrid& labels);

/// How much a reading of the values contradicts the CT and itself. Points: 1 for 100 HU, for 20 mm, or for twice the
/// largest volume beyond what is usual; at most 1.5 for a place or volume, 3 for HU and for the order of vertebrae.
struct ReadingMatch {
  double against = 0.0;           ///< All points.
  double agreed = 0.0;            ///< 0.5 for each vertebra that follows its upper neighbour.
  std::size_t compared = 0;       ///< Structures that are compared with others: independent of the CT.
  std::size_t misplaced = 0;      ///< So many of them must be left out before the others agree with each other.
  std::vector<std::string> most;  ///< What contradicts most, in words.
};

using ReadingNames = std::vector<std::pair<int, std::string>>;

/// The places are reversed along some axes (x, y, z of P) about the body's middle first.
ReadingMatch match_reading(const ValuesInCt& in_ct, const ReadingNames& names, const anatomy::KnownStructures& known,
                           const std::array<bool, 3>& reversed = {});

/// The match with the fewest contradictions of all reversals: a mirrored or turned segmentation contradicts in its
/// places, not by its numbers.
ReadingMatch match_any_direction(const ValuesInCt& in_ct, const ReadingNames& names,
                                 const anatomy::KnownStructures& known);

}  // namespace trocar::patient_builder::detail
