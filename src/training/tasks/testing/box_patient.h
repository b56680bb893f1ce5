#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "anatomy/patient.h"

namespace trocar::testing {

/// A patient made of shapes: a body box (|x| < 100, |y| < 70 mm, running through the volume along z) with 12 mm of fat,
/// 10 mm of muscle and a liver in the right half; lesion, ribs and a vessel as requested. Skin distance is exact.
struct BoxPatient {
  double spacing_mm = 2.0;
  Vec3 half_volume_mm{120.0, 90.0, 80.0};
  Vec3 lesion_centre_P{-30.0, -15.0, 0.0};
  double lesion_radius_mm = 8.0;  ///< 0: none.
  /// Tissue of a point instead of the standard one; empty: no change.
  std::function<std::string(const Vec3& p_P)> special;

  static constexpr std::array<const char*, 10> kNames = {"",    "fat",    "muscle", "liver",       "lesion",
                                                         "rib", "vessel", "lung",   "gallbladder", "soft"};
  static constexpr std::array<const char*, 10> kTissues = {"",     "adipose", "muscle", "liver",       "liver_lesion",
                                                           "bone", "vessel",  "lung",   "gallbladder", "soft_tissue"};

  static double skin_distance(const Vec3& p) {
    const double x = std::abs(p.x()) - 100.0;
    const double y = std::abs(p.y()) - 70.0;
    if (x <= 0 && y <= 0) return std::max(x, y);
    return std::hypot(std::max(x, 0.0), std::max(y, 0.0));
  }

  std::uint8_t label_at(const Vec3& p) const {
    if (skin_distance(p) >= 0.0) return 0;
    if (special) {
      const std::string tissue = special(p);
      for (std::size_t n = 1; n < kTissues.size(); ++n)
        if (tissue == kTissues[n]) return static_cast<std::uint8_t>(n);
    }
    if (lesion_radius_mm > 0.0 && (p - lesion_centre_P).norm() <= lesion_radius_mm) return 4;
    if (skin_distance(p) > -12.0) return 1;
    if (skin_distance(p) > -22.0) return 2;
    if (p.x() < 20.0 && std::abs(p.z()) < 60.0) return 3;
    return 9;
  }

  anatomy::VirtualPatient make() const {
    anatomy::VirtualPatient patient;
    patient.name = "box";
    volume::GridGeometry geometry;
    geometry.spacing_mm = Vec3::Constant(spacing_mm);
    for (int a = 0; a < 3; ++a)
      geometry.size[static_cast<std::size_t>(a)] =
          static_cast<std::int64_t>(std::floor(2.0 * half_volume_mm[a] / spacing_mm)) + 1;
    geometry.origin_P = -half_volume_mm;
    patient.labels = volume::LabelGrid(geometry);
    patient.skin_distance_mm = volume::FloatGrid(geometry);
    patient.ct = volume::CtGrid(geometry);
    for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
      const volume::Index3 ijk = geometry.index_of(n);
      const Vec3 p = geometry.centre_mm(ijk);
      patient.labels.voxels[n] = label_at(p);
      patient.skin_distance_mm.voxels[n] = static_cast<float>(skin_distance(p));
    }
    for (std::uint8_t id = 1; id < kNames.size(); ++id)
      patient.label_table.labels.push_back({id, kNames[id], kTissues[id], {}});
    return patient;
  }
};

}  // namespace trocar::testing
