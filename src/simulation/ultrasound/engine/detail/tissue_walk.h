#pragma once

#include <array>
#include <cstdint>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Marches a scanline of one plane through the tissues: what sound loses on the way, where it meets borders.
namespace trocar::ultrasound::detail {

inline constexpr int kMaxSamples = 4096;

/// What a walk leaves behind. Some 70 KiB, kept a thread.
struct alignas(64) WalkResult {
  std::array<std::array<float, kMaxSamples + 16>, 3> index;  ///< Place of each sample, fractional voxels.
  std::array<std::int32_t, kMaxSamples + 16>
      cell;                                      ///< Offset of its first voxel among the tiles; -1 beyond the volume.
  std::array<float, kMaxSamples + 16> log_gain;  ///< Of a scatterer there: loss and backscatter, neper.
  std::array<float, kMaxSamples + 16> log_way;   ///< Loss alone, neper.
  std::array<float, kMaxSamples + 16> sideways_mm;    ///< Displacement by refraction.
  std::array<std::uint8_t, kMaxSamples + 16> share;   ///< Class of the share of scatterers.
  std::array<std::uint8_t, kMaxSamples + 16> tissue;  ///< The nearest or prevailing one.
  std::array<Border, kMaxBorders> borders;
  int border_count = 0;
  int audible = 0;  ///< Samples before the shadow that nothing comes back from.
};

/// Walks; fills everything but `sideways_mm`, which it reads. For the central plane, `delay` (samples long) takes the
/// samples by which echoes come later; else it is nullptr.
void walk_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta, WalkResult& result,
               float* delay) noexcept;

/// Keeps a walk's borders with the frame.
void store_borders(const ScanPlan& plan, FrameState& frame, const WalkResult& result, int plane, int line) noexcept;

/// Only finds the places of the samples (index, cell).
void place_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
                WalkResult& result) noexcept;

/// Properties at a fractional voxel index, neighbours blended; the nearest tissue. Beyond the volume: at its edge.
struct Blend {
  TissueRow row;
  std::uint8_t tissue;
};
Blend blend_at(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, float i, float j,
               float k) noexcept;

/// Gradient of the impedance's logarithm at a fractional voxel index, a mm, in the scene's voxel axes; over 1.5 voxels.
Vec3 impedance_slope(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, const Vec3& index) noexcept;

}  // namespace trocar::ultrasound::detail
