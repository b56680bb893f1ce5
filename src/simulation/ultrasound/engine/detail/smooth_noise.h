#pragma once

namespace trocar::ultrasound::detail {

/// Smooth noise, -1..1, with a lattice unit of 1: a pure function of the position.
float smooth_noise(float x, float y, float z) noexcept;

}  // namespace trocar::ultrasound::detail
