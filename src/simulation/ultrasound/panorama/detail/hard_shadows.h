#pragma once

#include <vector>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/point_spread.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Shadows of bone and gas over a panorama (docs/physics.md U17): the paths of BMode with soft tissue that neither
/// attenuates nor reflects nor refracts, because the panorama already contains its losses.
namespace trocar::ultrasound::detail {

/// The plan of a scan whose soft tissues are all alike. Hard tissues, which reflect more than kHardReflection of the
/// amplitude at a border with soft tissue or attenuate more than kHardLoss_db_per_cm_mhz, keep their properties.
ScanPlan make_shadow_plan(const AcousticScene& scene, const Transducer& transducer, const Acquisition& acquisition);
inline constexpr double kHardReflection = 0.25;         ///< Assumed: bone 0.6, gas 1, fat 0.1. Range 0.15..0.5.
inline constexpr double kHardLoss_db_per_cm_mhz = 5.0;  ///< Assumed: cartilage 2, bone 15. Range 3..10.
/// A shadow begins this distance behind the border, so that the bright surface in front of it stays. Assumed: half the
/// thickness of the surface's echo and one voxel of a panorama. Range 0..3.
inline constexpr double kSurfaceEcho_mm = 1.2;
/// Least loss by which a shadow behind gas stays dark: repeated echoes between bubbles fill it, and a panorama contains
/// none at the places where it was imaged past the gas. Assumed, range 15..40.
inline constexpr double kGasShadow_db = 26.0;

/// Computes contact, walks and open_way of scanlines on several threads: open_way of `lines`, the others of `probed`.
/// frame.X_PT must be set. `scratch`: one per group of `probed`.
void find_hard_shadows(const AcousticScene& scene, const ScanPlan& plan, FrameState& frame, const LineRange& probed,
                       const LineRange& lines, std::vector<WalkResult>& scratch,
                       std::vector<float>& aperture_rows) noexcept;

/// Fills FrameState::way_gain of a scanline: shadow times `gain`, one value per sample. `logs`: samples + 16 values of
/// working memory.
void fill_way_gain(const ScanPlan& plan, FrameState& frame, int line, const std::vector<float>& gain,
                   std::vector<float>& logs) noexcept;

/// Patterns of a scan, line * samples values each (docs/physics.md U17).
struct HazePattern {
  /// Clutter: noise, spread as echoes are, with a mean power of 1 at each depth.
  std::vector<float> re, im;
  /// Phase of the panorama's echoes, of modulus 1: its gray values contain none, and echoes interfere with needles and
  /// with the clutter of the face.
  std::vector<float> phase_re, phase_im;
};

/// Uses the buffers of a frame and of its output, which are cleared again.
HazePattern make_haze_pattern(const ScanPlan& plan, FrameState& frame, SteeringRows& rows, BasebandFrame& out);

}  // namespace trocar::ultrasound::detail
