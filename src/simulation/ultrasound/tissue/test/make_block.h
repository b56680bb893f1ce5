#pragma once

#include <functional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "ultrasound/tissue/acoustic_table.h"
#include "volume/testing/centred_grid.h"

namespace trocar::testing {

/// A tissue's label and CT value at a point of P.
struct BlockVoxel {
  std::uint8_t label = 0;
  std::int16_t hu = 0;
};

/// Labels of a block: 1 liver, 2 kidney, 3 vessel, 4 muscle, 5 bone, 6 lung, 7 bowel, 8 fat.
inline constexpr std::uint8_t kLiver = 1, kKidney = 2, kVessel = 3, kMuscle = 4, kBone = 5, kLung = 6, kBowel = 7,
                              kFat = 8;

/// A synthetic patient: a block of tissue behind a flat skin at y = 0 (the body where y > 0), centred on x = z = 0,
/// with 12 mm of air in front.
inline anatomy::VirtualPatient make_block(const Vec3& extent_mm, const Vec3& spacing_mm,
                                          const std::function<BlockVoxel(const Vec3&)>& voxel) {
  constexpr double kAir_mm = 12.0;
  anatomy::VirtualPatient patient;
  patient.name = "block";
  volume::GridGeometry geometry = centred_grid(extent_mm, spacing_mm);
  geometry.origin_P.y() = 0.5 * spacing_mm.y() - kAir_mm;
  patient.ct = volume::CtGrid(geometry, -1000);
  patient.labels = volume::LabelGrid(geometry);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 p_P = geometry.centre_mm(ijk);
    patient.skin_distance_mm.voxels[n] = static_cast<float>(-p_P.y());
    if (p_P.y() <= 0.0) continue;
    const BlockVoxel made = voxel(p_P);
    patient.labels.voxels[n] = made.label;
    patient.ct.voxels[n] = made.hu;
  }
  const char* const names[] = {"liver", "kidney", "vessel", "muscle", "bone", "lung", "bowel", "adipose"};
  for (std::uint8_t id = 1; id <= 8; ++id)
    patient.label_table.labels.push_back({id, "the " + std::string(names[id - 1]), names[id - 1], {}});
  return patient;
}

/// A table of all tissues that a block may contain, without realistic acoustic values.
inline ultrasound::AcousticTable make_block_table() {
  ultrasound::AcousticTable table;
  for (const char* name : {"air", "skin", "adipose", "gas", "soft_tissue", "liver", "kidney", "vessel", "muscle",
                           "bone", "lung", "bowel"}) {
    ultrasound::AcousticTissue tissue;
    tissue.name = name;
    table.tissues.push_back(tissue);
  }
  return table;
}

}  // namespace trocar::testing
