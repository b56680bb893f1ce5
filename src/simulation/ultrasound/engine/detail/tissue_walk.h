#pragma once

#include <array>
#include <cstdint>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Marches a scanline of one plane through the tissues: computes losses and borders.
namespace trocar::ultrasound::detail {

inline constexpr int kMaxSamples = 4096;
/// Neper, 131 dB: beyond it even a perfect reflector, 48 dB above liver's speckle, is 20 dB below the receiver's noise
/// (-63 dB).
inline constexpr float kInaudible = -15.1F;

/// Result of a walk. About 120 KiB, one per thread.
struct alignas(64) WalkResult {
  std::array<std::array<float, kMaxSamples + 16>, 3> index;  ///< Position of each sample, fractional voxels.
  /// Offset of the first voxel of its cell among the tiles; -1 outside the volume.
  std::array<std::int32_t, kMaxSamples + 16> cell;
  std::array<float, kMaxSamples + 16> log_gain;  ///< Gain of a scatterer there: loss and backscatter, neper.
  /// Where the patient moves: from a sample's place now to its tissue at rest, index.
  alignas(64) std::array<std::array<float, kMaxSamples + 16>, 3> to_rest;
  std::array<float, kMaxSamples + 16> path_loss;      ///< Loss alone, neper.
  std::array<float, kMaxSamples + 16> sideways_mm;    ///< Displacement by refraction.
  std::array<std::uint8_t, kMaxSamples + 16> share;   ///< Class of the share of scatterers.
  std::array<std::uint8_t, kMaxSamples + 16> tissue;  ///< The nearest or prevailing tissue.
  std::array<Border, kMaxBorders> borders;
  int border_count = 0;
  int audible = 0;  ///< Samples in front of the shadow without echoes.
};

/// Walks one scanline; fills all fields except `sideways_mm`, which it reads. For the central plane, `delay` (as many
/// values as samples) receives the delays of echoes in samples; else it is nullptr. In front of sample `reach` the walk
/// continues through shadows, into which sound may come from the sides.
void walk_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta, int reach,
               WalkResult& result, float* delay) noexcept;

/// Stores a walk's borders as row `row` of the frame (ScanPlan::row_of).
void store_borders(FrameState& frame, const WalkResult& result, int row) noexcept;
/// Stores the borders of row `from` as those of a row half way to `other`, where that has the same borders.
void store_borders_between(FrameState& frame, int from, int other, int row) noexcept;

/// Fills WalkResult::to_rest for a line; place_line calls it where the patient moves.
void find_rest(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
               WalkResult& result) noexcept;
/// Computes only the positions of the samples (index, cell).
void place_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
                WalkResult& result) noexcept;

/// Properties at a fractional voxel index, interpolated between neighbours, and the nearest tissue. Outside the volume:
/// the values at its edge.
struct Blend {
  TissueRow row;
  std::uint8_t tissue;
};
Blend blend_at(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, float i, float j,
               float k) noexcept;

/// Gradient of the impedance's logarithm at a fractional voxel index, per mm, in the scene's voxel axes; over 1.5
/// voxels.
Vec3 impedance_slope(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, const Vec3& index) noexcept;

}  // namespace trocar::ultrasound::detail
