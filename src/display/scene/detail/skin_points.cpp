#include "scene/detail/skin_points.h"

#include <cmath>

namespace trocar::scene::detail {

std::vector<Vec3> skin_points(const anatomy::VirtualPatient& patient) {
  constexpr std::int64_t kStep = 4;
  const volume::FloatGrid& distance_mm = patient.skin_distance_mm;
  const volume::GridGeometry& geometry = distance_mm.geometry;
  const double near_mm = static_cast<double>(kStep) * geometry.spacing_mm.maxCoeff();
  std::vector<Vec3> points_P;
  for (std::int64_t k = 0; k < geometry.size[2]; k += kStep)
    for (std::int64_t j = 0; j < geometry.size[1]; j += kStep)
      for (std::int64_t i = 0; i < geometry.size[0]; i += kStep)
        if (std::abs(distance_mm[{i, j, k}]) < near_mm) points_P.push_back(geometry.centre_mm({i, j, k}));
  return points_P;
}

}  // namespace trocar::scene::detail
