#pragma once

#include <string>
#include <vector>

#include "registration/panorama/stitch.h"

namespace trocar::report {

/// The stitching of ultrasound volumes as one self-contained HTML page: volumes, graph of pairs with inliers, matches
/// drawn between slices, panorama with the borders between volumes (seams). `placed`: the volumes of the panorama.
std::string stitch_report(const std::vector<registration::PreparedVolume>& volumes,
                          const registration::Stitching& stitching,
                          const std::vector<registration::PlacedVolume>& placed,
                          const registration::Panorama& panorama);

}  // namespace trocar::report
