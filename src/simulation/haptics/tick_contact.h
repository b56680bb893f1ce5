#pragma once

#include "haptics/tick.h"

namespace trocar::haptics {

/// The tick of a transducer or a finger (physics.md B9, B10, T1): contact with the skin, weight compensation, limits of
/// the device. In the record the tool stands where the needle would: `tip_mm` and `axis` are its origin and +y as
/// shown, `depth_mm` the deepest indentation, `f_constraint_n` the contact force, `phase` outside or loading. Input as
/// tick() has found it usable. Real-time safe.
HapticOutput tick_contact(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept;

}  // namespace trocar::haptics
