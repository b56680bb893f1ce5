#pragma once

#include <Eigen/Geometry>
#include <string>

#include "anatomy/patient.h"
#include "volume/sampling.h"

namespace trocar::slices {

/// Directions of an image in P (LPS): +u to its right, +v down; unit vectors, perpendicular to each other. The view
/// direction is u x v, into the image.
struct SliceAxes {
  Vec3 u_P = Vec3::UnitX();
  Vec3 v_P = Vec3::UnitY();

  Vec3 normal_P() const noexcept { return u_P.cross(v_P); }
};

/// Radiological views: patient's right on the left; axial from the feet, coronal from the front with the head up,
/// sagittal from the patient's left with the head up and the front on the left.
enum class SliceOrientation { kAxial, kCoronal, kSagittal };
SliceAxes slice_axes(SliceOrientation orientation) noexcept;

/// Planes that contain or cross a needle's axis, perpendicular to each other (paper B, section 2.2).
enum class NeedlePlane {
  kAlong,        ///< Through the axis, as near to an axial slice as possible.
  kAlongTurned,  ///< Through the axis, rotated by 90 degrees from kAlong: nearest to the long axis of the body.
  kAcross        ///< Perpendicular to the axis, seen from the hub.
};
/// Axes of an image in such a plane. In planes along the needle, its tip points down, as under an ultrasound transducer
/// with a needle guide: the patient's right (turned: the head) is on the left for a needle from the front. The axes do
/// not depend on the roll of the needle; they jump only if the needle axis passes close to the body's long axis.
/// `axis_P`: hub to tip, unit.
SliceAxes needle_axes(const Vec3& axis_P, NeedlePlane plane) noexcept;

/// Geometry of a slice view: a plane, the point at the centre of its image, scale and size. Pixel centres lie at
/// integers: (0, 0) is the middle of the top left pixel.
struct SliceGeometry {
  SliceAxes axes;
  Vec3 center_P = Vec3::Zero();
  double mm_per_px = 1.0;  ///< > 0.
  int columns = 0;
  int rows = 0;

  Eigen::Vector2d to_pixel(const Vec3& p_P) const noexcept;
  /// The point of the plane at a pixel; exact inverse of to_pixel for points of the plane.
  Vec3 to_P(const Eigen::Vector2d& pixel) const noexcept;
  /// Signed distance of a point from the plane (mm), positive behind the image.
  double height_mm(const Vec3& p_P) const noexcept { return axes.normal_P().dot(p_P - center_P); }
  /// The sample points of its image.
  volume::SlicePlane plane() const noexcept;
  /// Changes the scale; the point at `pixel` does not move.
  void zoom_at(const Eigen::Vector2d& pixel, double new_mm_per_px) noexcept;
};

using Box = Eigen::AlignedBox3d;  ///< In P, mm.
/// The box around a volume, including the outer halves of border voxels.
Box volume_box(const volume::GridGeometry& geometry);
/// The box around the body; around the volume if no distance to the skin is known. Samples every fourth voxel.
Box body_box(const anatomy::VirtualPatient& patient);
/// Scale (mm per pixel) at which a box just fits into an image.
double fitting_scale(const Box& box, const SliceAxes& axes, int columns, int rows) noexcept;

/// Orientation letters of a direction in P, as in radiology: R L A P H F, the strongest first; a second or third if the
/// direction tilts towards it by more than 20 degrees ("RA"). Empty for a vector without a direction.
std::string direction_letters(const Vec3& direction_P);

}  // namespace trocar::slices
