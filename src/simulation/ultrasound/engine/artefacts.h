#pragma once

#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::ultrasound {

/// Deviations from straight propagation and single reflection; each can be switched off.
struct Artefacts {
  bool attenuation = true;       ///< Shadow behind bone and gas, enhancement behind fluid.
  bool downshift = true;         ///< Attenuation lowers the centre frequency: deeper echoes are wider and louder.
  bool reverberation = true;     ///< A-lines, ring-down at gas.
  bool mirror = true;            ///< Mirror image at a strong, smooth reflector (the diaphragm).
  bool refraction = true;        ///< Edge shadows, bent scanlines.
  bool range_distortion = true;  ///< Depth follows from time; the speed of sound differs between tissues.
  bool side_lobes = true;        ///< Side lobes.
  bool contact_loss = true;      ///< Air where the face has no contact with the skin.
  bool clutter = true;           ///< Haze of the near field, and of what is beside the beam.
  bool noise = true;             ///< Noise of the receiver; increases with depth because the gain does.

  bool operator==(const Artefacts&) const = default;
};

/// "attenuation", "downshift", "reverberation", "mirror", "refraction", "range-distortion", "side-lobes",
/// "contact-loss", "clutter", "noise".
std::vector<std::string_view> artefact_names();
/// Switches one off, or "all". An unknown name is an error that lists the names (exit status 2).
Status switch_off(Artefacts& artefacts, std::string_view name);

}  // namespace trocar::ultrasound
