#pragma once

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Clutter: sound from beside the beam and from detours returns with the echoes of its depth (docs/physics.md U9). It
/// fills cysts, vessels and shadows with haze.
namespace trocar::ultrasound::detail {

/// Level of clutter relative to the mean echoes around. Assumed: -25 to -30 dB in anechoic cysts in vivo.
inline constexpr float kClutter_db = -28.0F;

/// Measures the echoes of a scanline. Call after all echoes.
void measure_echoes(const ScanPlan& plan, FrameState& frame, int line) noexcept;

/// Sums what was measured. Call before add_clutter.
void sum_powers(const ScanPlan& plan, FrameState& frame) noexcept;

/// Mean power, over real and imaginary part, of the clutter from beside a scanline in a block of kLobeBlock samples.
/// Call after sum_powers.
float clutter_power(const ScanPlan& plan, const FrameState& frame, int line, std::size_t block) noexcept;

/// Adds clutter to scanlines [first, last).
void add_clutter(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

/// Lowers the echoes of a scanline to the level of the harmonic, which grows with depth. Nothing for a fundamental
/// beam.
void generate_harmonic(const ScanPlan& plan, FrameState& frame, int line) noexcept;

}  // namespace trocar::ultrasound::detail

/// Multiple reflections (docs/physics.md U7).
namespace trocar::ultrasound::detail {

/// Adds ring-down behind gas on one scanline, before the point spread.
void add_ring_down(const ScanPlan& plan, FrameState& frame, int line) noexcept;
/// Adds echoes between the face and a smooth reflector perpendicular to the scanline: all echoes repeat, each time
/// deeper by the reflector's depth (A-lines).
void add_reverberation(const ScanPlan& plan, const FrameState& frame, int angle, int line, BasebandFrame& out) noexcept;

}  // namespace trocar::ultrasound::detail
