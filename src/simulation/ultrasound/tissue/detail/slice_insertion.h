#pragma once

#include <cstdint>
#include <vector>

#include "ultrasound/sweep/freehand.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "volume/grid.h"

namespace trocar::ultrasound::detail {

/// Pixels first..last of a row that are in use.
struct PixelRun {
  int row, first, last;
};

/// Pixels of a picture that the options select, row by row.
std::vector<PixelRun> pixel_runs(const TrackedSequence& sequence, const FreehandOptions& options);

/// A picture and its transform from (column, row, 0, 1) to mm of the volume's P.
struct PlacedFrame {
  std::size_t frame;
  TrackedSequence::Matrix4 T_PI;
};

/// Part of a picture that the volume must contain: the clip rectangle within the picture, or without one the selected
/// pixels. At least one pixel.
ClipRectangle box_of(const TrackedSequence& sequence, const std::vector<PixelRun>& runs,
                     const FreehandOptions& options);

/// The smallest box along the axes of P that contains the centres of a rectangle's pixels in all frames.
struct Extent {
  Vec3 first_P, last_P;
};
Extent extent_of(const std::vector<PlacedFrame>& frames, const ClipRectangle& box);

/// Accumulated pixels of a voxel: gray times weight in the lower 36 bits, weight above; 256 is a whole pixel. A voxel
/// accepts at most a million whole pixels.
using GraySum = std::uint64_t;
inline constexpr int kWeightShift = 36;
inline constexpr GraySum kWholePixel = 256;

/// Inserts the pixels of all frames into cells (one per voxel of `grid`), frame after frame in each voxel.
void insert_frames(const TrackedSequence& sequence, const std::vector<PlacedFrame>& frames,
                   const std::vector<PixelRun>& runs, const FreehandOptions& options, const volume::GridGeometry& grid,
                   std::vector<GraySum>& cells);

/// Rounded gray of a cell; 0 without pixels.
inline std::uint8_t gray_of(GraySum cell) noexcept {
  const GraySum weight = cell >> kWeightShift;
  const GraySum sum = cell & ((GraySum{1} << kWeightShift) - 1);
  return weight == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>((sum + weight / 2) / weight);
}

}  // namespace trocar::ultrasound::detail
