#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "anatomy/patient.h"
#include "motion/testing/sliding_motion.h"

namespace trocar::testing {

/// A block of liver behind flat skin (y = 0, air in front), with a ball of bone as a tag.
struct BlockPatient {
  static constexpr double kTag_mm = 3.0;  ///< Radius of the tag.
  inline static const Vec3 kTag_A{5.0, 45.0, 4.0};
};

/// The block, which moves: beyond a plane at x = -40 mm it rests, elsewhere it shears along z, and a bump around the
/// tag pushes it to the front. `has_tag`: false leaves the ball out of labels and CT.
inline std::shared_ptr<const anatomy::VirtualPatient> block_patient(bool has_tag = true) {
  volume::GridGeometry geometry;
  geometry.size = {140, 130, 150};
  geometry.origin_P = {-70.0, -20.0, -75.0};
  anatomy::VirtualPatient patient;
  patient.name = "block";
  patient.ct = volume::CtGrid(geometry, -1000);
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  patient.label_table.labels = {{1, "liver", "liver", {120, 60, 50}}, {2, "tag", "bone", {230, 30, 30}}};
  for (std::size_t n = 0; n < patient.ct.voxels.size(); ++n) {
    const Vec3 p_A = geometry.centre_mm(geometry.index_of(n));
    patient.skin_distance_mm.voxels[n] = static_cast<float>(-p_A.y());
    if (p_A.y() < 0.0) continue;
    const double share =
        has_tag ? std::clamp(BlockPatient::kTag_mm - (p_A - BlockPatient::kTag_A).norm() + 0.5, 0.0, 1.0) : 0.0;
    patient.ct.voxels[n] = static_cast<std::int16_t>(60.0 + 1400.0 * share);
    patient.labels.voxels[n] = share >= 0.5 ? 2 : 1;
  }
  patient.motion = motion::testing::sliding_model(-40.0, BlockPatient::kTag_A);
  patient.content_hash = anatomy::hash_patient(patient);
  return std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
}

}  // namespace trocar::testing
