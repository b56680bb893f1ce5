#pragma once

#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::trainer {

/// A bracket on the transducer that guides a needle in the image plane.
struct NeedleGuide {
  bool is_shown = false;
  double angle_deg = 45.0;  ///< Angle between the guide and the central beam. Range 10..80.
  bool is_on_marked_side = true;

  bool operator==(const NeedleGuide&) const = default;
};

/// All controls of the ultrasound view.
struct UltrasoundSettings {
  ultrasound::Acquisition acquisition;
  ultrasound::DisplaySettings display;
  /// While transducer or needle moves, a picture renews a part of the scanlines, as in a scanner.
  bool is_rolling = false;
  bool is_gain_automatic = true;  ///< Set by the first image of a case, and on demand.
  /// The image is sliced from the patient's panorama; not stored: it belongs to the case.
  bool is_panorama = false;
  bool has_doppler = false;
  ultrasound::DopplerSettings doppler;
  NeedleGuide guide;

  bool operator==(const UltrasoundSettings&) const = default;
};

UltrasoundSettings default_settings(const ultrasound::Transducer& transducer);
/// Clamps every control to its range.
UltrasoundSettings within_ranges(const UltrasoundSettings& settings, const ultrasound::Transducer& transducer);

/// The stored settings of that transducer (QSettings, group "ultrasound"); the defaults if nothing is stored. Doppler
/// is initially off.
UltrasoundSettings load_settings(const ultrasound::Transducer& transducer);
void save_settings(const ultrasound::Transducer& transducer, const UltrasoundSettings& settings);

}  // namespace trocar::trainer
