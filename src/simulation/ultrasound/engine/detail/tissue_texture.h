#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Variation of the scatterers' brightness within one tissue (docs/physics.md U5).
namespace trocar::ultrasound::detail {

/// Values added to a walk's log_gain, neper, one per sample: the CT's texture, layers of muscle and fat.
/// `fibres` is made on the central plane and read on the others.
struct alignas(64) Texture {
  std::array<float, kMaxSamples + 16> added;
  std::array<float, kMaxSamples + 16> fibres;
};
/// Layers of muscle and fat along a probed scanline, for FrameState::layers.
void note_layers(const ScanPlan& plan, FrameState& frame, const WalkResult& walk, int line) noexcept;
/// Those of a scanline half way between two others.
void fill_layers_between(const ScanPlan& plan, FrameState& frame, int line, int before, int after) noexcept;

void make_texture(const ScanPlan& plan, const FrameState& frame, const WalkResult& walk, int line, bool is_central,
                  Texture& texture) noexcept;

}  // namespace trocar::ultrasound::detail

/// Sheets too thin for CT and labels: diaphragm, walls of vessels and hollow organs (docs/physics.md U6).
namespace trocar::ultrasound::detail {

/// Raises the scatterers' gain of a walk in the walls beside its borders. Call after make_texture.
void add_walls(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, WalkResult& walk,
               const Texture& texture) noexcept;

/// Smooth noise, -1..1, with a lattice unit of 1: a pure function of the position.
float smooth_noise(float x, float y, float z) noexcept;

}  // namespace trocar::ultrasound::detail
