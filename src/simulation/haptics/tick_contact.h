#pragma once

#include "haptics/tick.h"

namespace trocar::haptics {

/// The tick of a transducer or a finger (physics.md B9, B10, T1): contact with the skin, weight compensation, limits of
/// the device. The record holds the tool in the needle's fields: `tip_mm` and `axis` are its displayed origin and +y,
/// `depth_mm` is the deepest indentation, `f_constraint_n` is the contact force, `phase` is outside or loading. tick()
/// has checked the input. Real-time safe.
HapticOutput tick_contact(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept;

}  // namespace trocar::haptics
