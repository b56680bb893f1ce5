#pragma once

#include <Eigen/Geometry>
#include <string>

#include "anatomy/patient.h"
#include "volume/sampling.h"

namespace trocar::slices {

/// Directions of a picture in P (LPS): +u to its right, +v down, both of length 1 and square to each other. One looks
/// along u x v, into the picture.
struct SliceAxes {
  Vec3 u_P = Vec3::UnitX();
  Vec3 v_P = Vec3::UnitY();

  Vec3 normal_P() const noexcept { return u_P.cross(v_P); }
};

/// Radiological views: patient's right on the left; axial from the feet, coronal from the front with the head up,
/// sagittal from the patient's left with the head up and the front on the left.
enum class SliceOrientation { kAxial, kCoronal, kSagittal };
SliceAxes slice_axes(SliceOrientation orientation) noexcept;

/// Planes that hold or cross a needle's axis, square to each other (paper B, section 2.2).
enum class NeedlePlane {
  kAlong,        ///< Through the axis, as near to an axial slice as goes.
  kAlongTurned,  ///< Through the axis, a quarter turn from it: the one nearest to the long axis of the body.
  kAcross        ///< Square to the axis, seen from the hub.
};
/// Axes of a picture in such a plane. Along the needle its tip points down, as under an ultrasound transducer that
/// holds it: the patient's right (turned: the head) is on the left for a needle from the front. They do not follow the
/// roll of the needle, and so stand still while it is rolled; they jump only where the axis passes close to the body's
/// long axis. `axis_P`: hub to tip, unit.
SliceAxes needle_axes(const Vec3& axis_P, NeedlePlane plane) noexcept;

/// What a viewer shows: a plane, the point at the middle of its picture, its scale and size. Pixel centres lie at
/// integers: (0, 0) is the middle of the top left pixel.
struct SliceGeometry {
  SliceAxes axes;
  Vec3 center_P = Vec3::Zero();
  double mm_per_px = 1.0;  ///< > 0.
  int columns = 0;
  int rows = 0;

  Eigen::Vector2d to_pixel(const Vec3& p_P) const noexcept;
  /// The point of the plane behind a pixel; exact inverse of to_pixel for points of the plane.
  Vec3 to_P(const Eigen::Vector2d& pixel) const noexcept;
  /// Height of a point over the plane (mm), positive behind the picture.
  double height_mm(const Vec3& p_P) const noexcept { return axes.normal_P().dot(p_P - center_P); }
  /// The sample points of its picture.
  volume::SlicePlane plane() const noexcept;
  /// Changes the scale and keeps the point under a pixel where it is.
  void zoom_at(const Eigen::Vector2d& pixel, double new_mm_per_px) noexcept;
};

using Box = Eigen::AlignedBox3d;  ///< In P, mm.
/// The box around a volume, voxels' borders included.
Box volume_box(const volume::GridGeometry& geometry);
/// The box around the body; around the volume where no distance to the skin is known. Looks at every fourth voxel.
Box body_box(const anatomy::VirtualPatient& patient);
/// Scale (mm per pixel) at which a box just fits into a picture.
double fitting_scale(const Box& box, const SliceAxes& axes, int columns, int rows) noexcept;

/// Letters for a direction of P as radiologists write them beside a picture: R L A P H F, the strongest first; a second
/// or third where the direction leans to it by more than 20 degrees ("RA"). Nothing for a vector that is no direction.
std::string direction_letters(const Vec3& direction_P);

}  // namespace trocar::slices
