#pragma once

#include <cstdint>
#include <memory>

#include "core/progress.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/scanner/display_settings.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// Positions of the samples of a swung array. The motor's axis is the line y = -radius_mm, z = 0 of T, the transducer's
/// frame in the middle of the swing. A rotation by angle a moves a point (x, y, 0) of the array's plane to (x, (y +
/// radius) cos a - radius, (y + radius) sin a): docs/physics.md U14.
struct SweepGeometry {
  ScanGeometry scan;
  double radius_mm = 27.0;  ///< Distance from the motor's axis to the middle of the face. Range 0..200.
  double sweep_rad = 1.3;   ///< Angle between the outermost frames. Range 0.01..pi/2.
  int frames = 101;         ///< Range 2..1000.

  /// A sample in sweep coordinates: frame (fractional, 0 is at the most negative z), scanline, depth.
  struct Place {
    double frame = 0.0;
    Polar polar;
  };
  double frame_angle_rad(double frame) const noexcept { return (frame / (frames - 1) - 0.5) * sweep_rad; }
  /// Pose of the swung array in T.
  Pose frame_pose(double frame) const noexcept;
  /// Exact inverses of each other in front of the motor's axis: in a frame's plane, y > -radius_mm.
  Vec3 to_cartesian(const Place& place) const noexcept;
  Place to_place(const Vec3& p_T) const noexcept;
  /// Smallest box of T that contains all samples.
  struct Extent {
    Vec3 first_T, last_T;
  };
  Extent extent() const noexcept;
};

struct MechanicalSweepOptions {
  Acquisition acquisition;
  DisplaySettings display;  ///< Without persistence; mirroring has no effect here.
  double sweep_rad = 0.0;   ///< 0: the transducer's own.
  /// Angle between frames. Volume probes step by 0.4 to 2 degrees; smaller steps give better volumes: assumed 0.75,
  /// range 0.4..2.
  double step_rad = 0.0131;
  double spacing_mm = 0.7;  ///< Spacing of the volume's voxels. Range 0.2..5.
  std::uint64_t seed = 1;   ///< Seed of the receiver's noise.
};

/// A volume of a mechanical 3D transducer.
struct SweepVolume {
  volume::LabelGrid gray;  ///< Gray 1..255; 0 beside the fan. Its axes are those of T in the middle of the swing.
  SweepGeometry geometry;
  double mean_contact = 1.0;  ///< Share of all frames' scanlines that are coupled to the skin.
};

/// Swings the array of a transducer at the constant pose X_PT, and resamples the frames' gray levels to a volume. The
/// result is bitwise independent of the number of threads. Errors (exit status 2): a transducer without a motor,
/// options out of range, a volume above 256 million voxels.
Result<SweepVolume> make_mechanical_sweep(const std::shared_ptr<const AcousticScene>& scene,
                                          const Transducer& transducer, const Pose& X_PT,
                                          const MechanicalSweepOptions& options, const Progress& progress = {});

/// The same voxels, placed in the patient.
volume::LabelGrid in_patient(const SweepVolume& volume, const Pose& X_PT);

}  // namespace trocar::ultrasound
