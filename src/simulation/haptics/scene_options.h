#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// The force model, every other option of a scene's force law and the numbers of its device as text:
/// "force_model=proxy", "coupling.stiffness=0.8", "device.peak_force=37.5". Numbers in the shortest form that reads
/// back to the same value. The seed, the tool, the needle and the tissues are not among them.
std::vector<std::string> option_texts(const HapticScene& scene);

/// Reads them back, in any order; what is not named stays as it is. The path constraint stays as it is, too: the
/// scene's is the one that the device can render, which make_haptic_scene derives from the preset's, device and needle.
/// Errors (exit status 2): an unknown name, not a finite number. Ranges are checked by make_haptic_scene.
Status restore_options(std::span<const std::string> texts, HapticOptions& options, DeviceCapability& device);

}  // namespace trocar::haptics
