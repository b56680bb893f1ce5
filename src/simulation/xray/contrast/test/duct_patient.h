#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/shapes.h"
#include "volume/testing/centred_grid.h"

namespace trocar::testing {

struct LabelledShape {
  std::string name;
  std::string tissue;
  std::function<bool(const Vec3&)> contains;
};

/// A tube with round ends.
inline std::function<bool(const Vec3&)> tube(const Vec3& a, const Vec3& b, double radius_mm) {
  return [=](const Vec3& p) { return distance_mm(Segment{a, b}, p) <= radius_mm; };
}

inline std::function<bool(const Vec3&)> ball(const Vec3& centre, double radius_mm) {
  return [=](const Vec3& p) { return (p - centre).norm() <= radius_mm; };
}

inline std::function<bool(const Vec3&)> everywhere() {
  return [](const Vec3&) { return true; };
}

/// A patient with labels only, centred on the origin. A later shape covers the earlier ones.
inline std::shared_ptr<anatomy::VirtualPatient> make_labelled_patient(const Vec3& extent_mm, const Vec3& spacing_mm,
                                                                      const std::vector<LabelledShape>& shapes) {
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->name = "shapes";
  const volume::GridGeometry geometry = centred_grid(extent_mm, spacing_mm);
  patient->labels = volume::LabelGrid(geometry);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    patient->label_table.labels.push_back({static_cast<std::uint8_t>(s + 1), shapes[s].name, shapes[s].tissue, {}});
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
    for (std::size_t s = shapes.size(); s-- > 0;)
      if (shapes[s].contains(p_P)) {
        patient->labels.voxels[n] = static_cast<std::uint8_t>(s + 1);
        break;
      }
  }
  return patient;
}

}  // namespace trocar::testing
