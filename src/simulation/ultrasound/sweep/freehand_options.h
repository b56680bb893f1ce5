#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"

namespace trocar::ultrasound {

/// How a pixel enters the voxels about it.
enum class FreehandInterpolation {
  kNearest,  ///< The nearest voxel takes all of it.
  kLinear,   ///< The eight voxels about it, by trilinear weights.
};

/// What becomes of several pixels in one voxel.
enum class FreehandCompounding { kMean, kMaximum, kLatest };

/// How a voxel that no pixel met gets its gray value.
struct HoleFilling {
  enum class Kind {
    kStick,     ///< Linear between the two known voxels on the shortest of 13 lines through the hole.
    kNearest,   ///< Mean of the known voxels in the smallest cube about it that has any.
    kGaussian,  ///< Gaussian mean of the known voxels of a cube.
  };
  Kind kind = Kind::kStick;
  int stick_length_limit = 9;  ///< Voxels from known to known, both counted. Range 3..65. Default: PLUS' example.
  int sticks = 1;              ///< So many of the shortest count, and their equals. Range 1..13.
  int size = 5;                ///< Edge of the cube, voxels. Odd, 3..33. The default is assumed.
  double sigma_voxels = 1.0;   ///< Of the Gaussian. Range 0.1..16. The default is assumed.
  double least_share = 0.0;    ///< More than this share of the cube must be known. Range 0..1.
};

/// Pixels that count: from (first_column, first_row) over so many columns and rows.
struct ClipRectangle {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

/// Part of a ring about (origin_column, origin_row), which may lie outside the picture. Square pixels.
struct ClipFan {
  double origin_column = 0.0, origin_row = 0.0;
  double first_angle_rad = -0.6, last_angle_rad = 0.6;  ///< 0 is down the picture, positive to rising columns.
  double first_radius_px = 0.0, last_radius_px = 0.0;
};

/// How a tracked sequence becomes a volume; names and meaning as in PLUS' <VolumeReconstruction>.
struct FreehandOptions {
  std::string image_frame = "Image";
  std::string reference_frame = "Reference";  ///< The volume's axes are those of this frame.
  Vec3 spacing_mm{1.0, 1.0, 1.0};             ///< Range 0.01..100.
  FreehandInterpolation interpolation = FreehandInterpolation::kNearest;
  FreehandCompounding compounding = FreehandCompounding::kMean;
  std::optional<ClipRectangle> rectangle;
  std::optional<ClipFan> fan;
  double least_gray = 0.0;         ///< Darker pixels do not count. Range 0..255.
  bool is_black_left_out = false;  ///< Pixels that are black in all frames (beside the fan) do not count.
  std::vector<HoleFilling> holes;  ///< Tried in this order; none: holes stay 0.
};

}  // namespace trocar::ultrasound
