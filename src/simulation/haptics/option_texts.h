#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// Sets the options of a scene for this device: its coupling, and no constraint stiffer than that coupling.
void apply_device_preset(const stylus::DevicePreset& preset, HapticOptions& options) noexcept;

/// Texts of the force model, of every other option of a scene's force law and of its device's parameters:
/// "force_model=proxy", "coupling.stiffness=0.8", "device.peak_force=37.5". Numbers have the shortest form that reads
/// back to the same value. The seed, the tool, the needle and the tissues are not included.
std::vector<std::string> option_texts(const HapticScene& scene);

/// Reads these texts, in any order; an option without a text keeps its value. The path constraint is not restored
/// either: make_haptic_scene derives the scene's from the preset's, the device and the needle, so that the device can
/// render it. Errors (exit status 2): an unknown name, a number that is not finite. make_haptic_scene checks the
/// ranges.
Status restore_options(std::span<const std::string> texts, HapticOptions& options, stylus::DeviceCapability& device);

}  // namespace trocar::haptics
