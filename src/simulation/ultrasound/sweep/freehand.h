#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "geometry/vec.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// Distribution of a pixel to the voxels around it.
enum class FreehandInterpolation {
  kNearest,  ///< The nearest voxel receives the whole pixel.
  kLinear,   ///< The eight surrounding voxels, by trilinear weights.
};

/// Combination of several pixels in one voxel.
enum class FreehandCompounding { kMean, kMaximum, kLatest };

/// Gray value of a voxel without pixels.
struct HoleFilling {
  enum class Kind {
    kStick,     ///< Linear between the two known voxels on the shortest of 13 lines through the hole.
    kNearest,   ///< Mean of the known voxels in the smallest cube about it that has any.
    kGaussian,  ///< Gaussian mean of the known voxels of a cube.
  };
  Kind kind = Kind::kStick;
  /// Voxels from one known voxel to the other, including both. Range 3..65. Default: PLUS' example.
  int stick_length_limit = 9;
  int sticks = 1;             ///< Number of the shortest lines that count, plus lines of equal length. Range 1..13.
  int size = 5;               ///< Edge of the cube, voxels. Odd, 3..33. The default is assumed.
  double sigma_voxels = 1.0;  ///< Sigma of the Gaussian. Range 0.1..16. The default is assumed.
  double least_share = 0.0;   ///< The share of known voxels in the cube must be larger. Range 0..1.
};

/// Rectangle of pixels in use: first column and row, numbers of columns and rows.
struct ClipRectangle {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

/// Part of a ring about (origin_column, origin_row); the origin may lie outside the picture. Square pixels.
struct ClipFan {
  double origin_column = 0.0, origin_row = 0.0;
  double first_angle_rad = -0.6,
         last_angle_rad = 0.6;  ///< 0 points down the picture; positive angles point to increasing columns.
  double first_radius_px = 0.0, last_radius_px = 0.0;
};

/// Options of the reconstruction of a volume; names and meaning as in PLUS' <VolumeReconstruction>.
struct FreehandOptions {
  std::string image_frame = "Image";
  std::string reference_frame = "Reference";  ///< The volume's axes are those of this frame.
  Vec3 spacing_mm{1.0, 1.0, 1.0};             ///< Range 0.01..100.
  FreehandInterpolation interpolation = FreehandInterpolation::kNearest;
  FreehandCompounding compounding = FreehandCompounding::kMean;
  std::optional<ClipRectangle> rectangle;
  std::optional<ClipFan> fan;
  double least_gray = 0.0;         ///< Darker pixels are ignored. Range 0..255.
  bool is_black_left_out = false;  ///< Pixels that are black in all frames (beside the fan) are ignored.
  std::vector<HoleFilling> holes;  ///< Tried in this order; empty: holes stay 0.
};

/// A volume reconstructed from tracked pictures.
struct FreehandVolume {
  volume::LabelGrid gray;  ///< 0..255; 0 also for unknown voxels. Its P is the reference frame, taken as LPS, mm.
  std::size_t frames_used = 0;
  std::size_t frames_left_out = 0;  ///< Invalid pictures, and pictures without a known pose.
  std::size_t voxels_met = 0;       ///< Voxels that received a pixel.
  std::size_t holes_filled = 0;
};

/// Reconstructs the smallest volume that contains all pictures of a freehand sweep (docs/physics.md U12).
/// `calibration`: constant transforms, such as ImageToProbe; a frame's own transforms take precedence. The result does
/// not depend on the number of threads. Errors: no frame has a chain of transforms from the image to the reference
/// frame (the message names the missing part), a volume above 256 million voxels, no pixels left by the clipping,
/// options out of range.
Result<FreehandVolume> reconstruct_freehand(const TrackedSequence& sequence,
                                            const TrackedSequence::Transforms& calibration,
                                            const FreehandOptions& options, const Progress& progress = {});

}  // namespace trocar::ultrasound
