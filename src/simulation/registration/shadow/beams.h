#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Texts of an image header (io::ImageFields).
using HeaderFields = std::map<std::string, std::string>;

/// Directions of sound in an ultrasound volume: parallel along an axis of the grid, or the fan of a swung convex array
/// (docs/physics.md U14). All points are in the frame of the volume's geometry ("P" of GridGeometry).
class Beams {
 public:
  /// A sample in beam coordinates. Parallel: lateral and elevation are mm. Fan: angles in rad.
  struct Place {
    double lateral = 0.0;
    double elevation = 0.0;
    double depth_mm = 0.0;  ///< From the face of the transducer; parallel: from the first plane of the grid.
  };

  /// Parallel beams. `axis`: "+x", "-x", … "+z", a direction along the index axes. Error (exit status 2): anything
  /// else.
  static Result<Beams> along_axis(std::string_view axis, const volume::GridGeometry& geometry);
  /// Beams of a volume's header (trocar_apex_mm, trocar_radius_mm, trocar_depth_mm, trocar_fov_rad, trocar_beam_axis,
  /// and of the swing trocar_sweep_rad, trocar_sweep_radius_mm). Only a beam axis, or no field: parallel along it, or
  /// along +y. Errors: an incomplete fan, text that is no number, values out of range.
  static Result<Beams> from_header(const HeaderFields& fields, const volume::GridGeometry& geometry);

  /// along_axis() if `axis` is not empty, else from_header().
  static Result<Beams> choose(std::string_view axis, const HeaderFields& fields, const volume::GridGeometry& geometry);

  Place to_place(const Vec3& p) const noexcept;
  /// Inverse of to_place within the fan.
  Vec3 to_point(const Place& place) const noexcept;
  /// Unit direction away from the transducer.
  Vec3 direction(const Vec3& p) const noexcept;
  bool is_inside(const Place& place) const noexcept;
  bool is_fan() const noexcept { return is_fan_; }
  /// Of a fan: angle from the middle to the edge, and angle of the swing to each side (rad), depth (mm).
  double half_view_rad() const noexcept { return half_view_rad_; }
  double half_sweep_rad() const noexcept { return half_sweep_rad_; }
  double depth_mm() const noexcept { return depth_mm_; }
  /// Distance (mm) to the nearest edge of the imaged region, beside or beyond it; negative outside. Parallel: to the
  /// sides of the grid.
  double distance_to_edge_mm(const Place& place) const noexcept;

 private:
  bool is_fan_ = false;
  Mat3 R_PB_ = Mat3::Identity();   ///< Columns: lateral, beam, elevation.
  Vec3 p_PB_ = Vec3::Zero();       ///< Fan: middle of the face. Parallel: first corner.
  Vec3 extent_mm_ = Vec3::Zero();  ///< Parallel: lateral, depth, elevation.
  double radius_mm_ = 0.0;         ///< Face.
  double sweep_radius_mm_ = 0.0;   ///< From the motor's axis to the face.
  double depth_mm_ = 0.0;
  double half_view_rad_ = 0.0;
  double half_sweep_rad_ = 0.0;
};

}  // namespace trocar::registration
