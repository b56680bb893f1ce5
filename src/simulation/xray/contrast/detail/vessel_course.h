#pragma once

#include <functional>
#include <vector>

#include "geometry/vec.h"

namespace trocar::xray::detail {

/// Way of a stream of contrast agent from a tip through a vessel, in equal steps. Frame P.
struct VesselCourse {
  struct Station {
    Vec3 p_P = Vec3::Zero();
    Vec3 along_P = Vec3::UnitX(), u_P = Vec3::UnitY(), w_P = Vec3::UnitZ();  ///< Unit, perpendicular to each other.
    double lumen_mm = 0.0;   ///< Distance to the vessel's wall across the way.
    double stream_mm = 0.0;  ///< Radius of the stream: it fans from the tip to the wall.
    double swept_mm3 = 0.0;  ///< Integral of the square of that radius from the first station.
  };
  static constexpr double kStep_mm = 1.0;

  std::vector<Station> stations;  ///< At least one. From upstream to downstream.
  double first_mm = 0.0;          ///< Place of the first station along the way; the tip is at 0. <= 0.

  double last_mm() const { return first_mm + kStep_mm * static_cast<double>(stations.size() - 1); }
  /// Station at a place, interpolated; places beyond the ends are at the ends.
  Station at(double place_mm) const;
};

/// Follows the flow from a tip until the vessel ends, at most 200 mm down and 15 mm up the flow, and moves towards the
/// middle of the lumen. Without flow at the tip: along the vessel. `is_vessel`: of a point of P; `flow`: mean velocity
/// of the blood (mm/s) there. `slope`: growth of the stream's radius per length.
VesselCourse find_vessel_course(const Vec3& tip_P, const std::function<bool(const Vec3&)>& is_vessel,
                                const std::function<Vec3(const Vec3&)>& flow, double slope);

}  // namespace trocar::xray::detail
