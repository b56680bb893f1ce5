#pragma once

#include <vector>

#include "ultrasound/engine/beam.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// Amplitude of the harmonic at each sample of a scanline, over that at the focus. docs/physics.md U19.
std::vector<float> harmonic_levels(const Beam& beam, const ScanGeometry& geometry);
/// Gain (dB) with which a scanner makes up for a level: its inverse, at most kMostHarmonicGain_db.
double harmonic_gain_db(float level) noexcept;
inline constexpr double kMostHarmonicGain_db = 24.0;  ///< Near the face there is no harmonic yet. [assumed]

}  // namespace trocar::ultrasound
