#pragma once

#include <vector>

#include "anatomy/label_statistics.h"
#include "core/result.h"
#include "volume/grid.h"

namespace trocar::anatomy {

/// value -> slope * value + intercept, rounded.
struct Rescale {
  double slope = 1.0;      ///< HU per stored number. Range 1e-4..1e4.
  double intercept = 0.0;  ///< HU of the stored number 0. Range -1e6..1e6.
};

/// Converts stored numbers to HU, for a CT whose file lacks them (--rescale). Values below -32768 become -32768; a
/// value above 32767 is an error.
Status apply_rescale(const Rescale& rescale, volume::CtGrid& ct);

/// Whether a CT has to show air.
enum class AirIn { kAroundTheBody, kNowhere /* a CT that ends inside the body */ };

/// Checks that the numbers of a CT can be HU: air is present, and most of the rest is soft tissue. Fails if the rescale
/// tags are missing (air at 0) or applied twice, or for an exported 8-bit image. Errors state the range found. Every
/// build calls this: without air no skin is found, and the noise of a whole volume becomes structures.
Status check_hounsfield(const volume::CtGrid& ct, AirIn air = AirIn::kAroundTheBody);

/// By how much ranges are widened on both sides.
struct HuMargin {
  double hu = 0.0;     ///< Of the mean.
  double share = 0.0;  ///< Of the voxels that are gas or bone.
};

/// Labels with a mean HU, or a share of gas or bone, that is implausible for their tissue. Ranges are wide; small
/// labels are not checked. `judged_count`: how many were.
std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics,
                                         std::size_t* judged_count = nullptr, const HuMargin& margin = {});

}  // namespace trocar::anatomy
