#include "ultrasound/sweep/freehand.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/result.h"
#include "ultrasound/sweep/detail/hole_filling.h"
#include "ultrasound/sweep/detail/limits.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "ultrasound/tissue/detail/slice_insertion.h"

namespace trocar::ultrasound {
namespace {

using detail::is_within;

constexpr std::size_t kGrain = 1 << 16;

Status check_holes(const HoleFilling& way) {
  if (!is_within(way.stick_length_limit, 3, 65))
    return fail_usage("the stick length limit is not within 3..65 voxels", "StickLengthLimit",
                      "choose a number in this range");
  if (!is_within(way.sticks, 1, 13))
    return fail_usage("the number of sticks is not within 1..13", "NumberOfSticksToUse",
                      "choose a number in this range");
  if (!is_within(way.size, 3, 33) || way.size % 2 == 0)
    return fail_usage("the size of a hole filling cube is not odd within 3..33 voxels", "Size",
                      "choose an odd number in this range");
  if (!is_within(way.sigma_voxels, 0.1, 16.0))
    return fail_usage("the deviation of a hole filling Gaussian is not within 0.1..16 voxels", "Stdev",
                      "choose a number in this range");
  if (!is_within(way.least_share, 0.0, 1.0))
    return fail_usage("a share of known voxels is not within 0..1", "MinimumKnownVoxelsRatio",
                      "choose a number in this range");
  return {};
}

Status check(const TrackedSequence& sequence, const FreehandOptions& options) {
  TROCAR_CHECK(sequence.pixels.size() == sequence.frame_pixels() * sequence.frames.size());
  for (int axis = 0; axis < 3; ++axis)
    if (!is_within(options.spacing_mm[axis], 0.01, 100.0))
      return fail_usage(fmt::format("a spacing of {} mm is not within 0.01..100", options.spacing_mm[axis]), "spacing",
                        "choose a spacing in this range");
  for (const HoleFilling& way : options.holes) TROCAR_TRY_STATUS(check_holes(way));
  return {};
}

Result<std::vector<detail::PlacedFrame>> place_frames(const TrackedSequence& sequence,
                                                      const TrackedSequence::Transforms& calibration,
                                                      const FreehandOptions& options) {
  std::vector<detail::PlacedFrame> placed;
  std::string reason = "no frame of the sequence is marked as valid";
  for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
    const TrackedSequence::Frame& frame = sequence.frames[n];
    if (!frame.is_valid) continue;
    TransformGraph graph;
    graph.add(calibration);
    graph.add(frame.transforms);
    const auto T_PI = graph.find(options.image_frame, options.reference_frame);
    if (T_PI && T_PI->allFinite()) {
      placed.push_back({n, *T_PI});
    } else {
      reason = fmt::format("frame {}: {}", n, graph.explain(options.image_frame, options.reference_frame));
    }
  }
  if (placed.empty())
    return fail(std::move(reason), {}, "give the missing transforms with a calibration, or another reference frame");
  return placed;
}

/// Voxels along one axis: the last one that a pixel can reach, by nearest neighbour or interpolation.
double voxels_along(double length_mm, double spacing_mm, FreehandInterpolation interpolation) {
  const double last = length_mm / spacing_mm;
  return 1.0 + (interpolation == FreehandInterpolation::kLinear ? std::ceil(last) : std::floor(last + 0.5));
}

Result<volume::GridGeometry> lay_grid(const detail::Extent& extent, const FreehandOptions& options) {
  const Vec3& spacing_mm = options.spacing_mm;
  const Vec3 length_mm = extent.last_P - extent.first_P;
  Vec3 size;
  for (int axis = 0; axis < 3; ++axis)
    size[axis] = voxels_along(length_mm[axis], spacing_mm[axis], options.interpolation);
  if (!(size.prod() <= detail::kMaxVoxels))  // also NaN
    return fail(fmt::format("the volume would have {:.0f} x {:.0f} x {:.0f} voxels", size[0], size[1], size[2]), {},
                "choose a larger spacing, and check that the transforms are in mm");
  volume::GridGeometry grid;
  grid.origin_P = extent.first_P;
  grid.spacing_mm = spacing_mm;
  for (int axis = 0; axis < 3; ++axis)
    grid.size[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(size[axis]);
  return grid;
}

}  // namespace

Result<FreehandVolume> reconstruct_freehand(const TrackedSequence& sequence,
                                            const TrackedSequence::Transforms& calibration,
                                            const FreehandOptions& options, const Progress& progress) {
  TROCAR_TRY_STATUS(check(sequence, options));
  TROCAR_TRY(const auto frames, place_frames(sequence, calibration, options));
  const auto runs = detail::pixel_runs(sequence, options);
  if (runs.empty()) return fail("the clip region contains no pixels", {}, "check the clip rectangle and the fan");
  TROCAR_TRY(const volume::GridGeometry grid,
             lay_grid(detail::extent_of(frames, detail::box_of(sequence, runs, options)), options));

  report(progress, "inserting the pictures", 0.0);
  std::vector<detail::GraySum> cells(grid.voxel_count(), 0);
  detail::insert_frames(sequence, frames, runs, options, grid, cells);

  FreehandVolume volume;
  volume.frames_used = frames.size();
  volume.frames_left_out = sequence.frames.size() - frames.size();
  volume.gray = volume::LabelGrid(grid);
  std::vector<std::uint8_t> known(cells.size());
  parallel_for(cells.size(), kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      volume.gray.voxels[n] = detail::gray_of(cells[n]);
      known[n] = cells[n] != 0 ? 1 : 0;
    }
  });
  volume.voxels_met = std::accumulate(known.begin(), known.end(), std::size_t{0});
  cells = {};
  report(progress, "filling holes", 0.6);
  volume.holes_filled = detail::fill_holes(volume.gray, known, options.holes);
  report(progress, "done", 1.0);
  return volume;
}

}  // namespace trocar::ultrasound
