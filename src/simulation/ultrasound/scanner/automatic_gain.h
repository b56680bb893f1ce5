#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// Gray that the automatic gain gives the brightness of tissue. Assumed: a mid gray on the dark side, as scanners do.
inline constexpr int kAutomaticGray = 96;

/// Gain (dB) with which the tissue of a frame has the gray kAutomaticGray with the other display settings, as a
/// scanner's button for automatic gain sets it. `levels`: of the scan, see Scanner::levels(). Tissue: the level that a
/// third of the samples with an echo exceed. Within the range of the gain; empty where less than a tenth of the scan
/// has an echo (a transducer in the air).
std::optional<double> automatic_gain_db(std::span<const std::uint8_t> levels, const DisplaySettings& settings);

}  // namespace trocar::ultrasound
