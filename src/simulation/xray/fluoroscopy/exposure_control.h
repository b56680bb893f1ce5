#pragma once

#include <functional>
#include <map>

#include "xray/geometry/c_arm.h"
#include "xray/physics/beam.h"
#include "xray/projection/mass_image.h"

namespace trocar::xray {

/// Dose: half, normal and double air kerma at the detector for fluoroscopy; kAcquisition for runs that are subtracted.
enum class DoseMode { kLow, kNormal, kHigh, kAcquisition };

/// Limits of the automatic exposure control (docs/physics.md, X11).
struct ExposureLimits {
  /// Air kerma at the detector per pulse, without the grid. At 15 pulses per s 0.5 µGy/s, a third of the greatest
  /// that Belgian law permits for fluoroscopy (FANC, 1.5 µGy/s). Range 5..500.
  double detector_ngy = 33.0;
  double acquisition_ngy = 1000.0;  ///< The same for acquisitions; FANC permits 4 µGy. Range 100..5000.
  /// Edge of the field for which these doses hold; a smaller field has the more, in proportion to 1 / edge, at most
  /// three times as much; assumed. Range 50..500.
  double field_mm = 300.0;
  double least_kv = 60.0;              ///< Range 40..150.
  double most_kv = 120.0;              ///< Range least_kv..150.
  double least_mas = 0.002;            ///< Of a pulse, as the next two. Range 0.0001..most_mas; assumed.
  double most_mas = 1.5;               ///< 150 mA for 10 ms; assumed.
  double most_acquisition_mas = 30.0;  ///< 600 mA for 50 ms; assumed.
  /// Greatest air kerma rate at the reference point (21 CFR 1020.32 (d)); not for acquisitions. Range 1..500.
  double most_mgy_per_min = 88.0;
};

/// One pulse of the tube.
struct Exposure {
  Tube tube;
  double mas = 0.1;
  bool is_limited = false;  ///< The detector has less than its dose: a limit is reached.

  bool operator==(const Exposure&) const = default;
};

/// Beams by tube. Making one takes milliseconds; exposure control steps the voltage by 2 kV and comes back to the same.
class BeamCache {
 public:
  /// `scintillator_mm`: thickness of the detector's caesium iodide.
  explicit BeamCache(double scintillator_mm = 0.6) : scintillator_mm_(scintillator_mm) {}
  Result<Beam> beam(const Tube& tube);

 private:
  double scintillator_mm_;
  std::map<std::array<double, 3>, Beam> beams_;
};

/// Voltage behind a mass of body (g/cm²), in steps of 2 kV: 60 kV to 8 g/cm², 2.5 kV per g/cm² above; assumed.
double kv_of_body(double g_per_cm2, const ExposureLimits& limits) noexcept;

/// Exposure of a pulse that gives the detector its dose behind the patient, in the middle half of the collimated field;
/// direct radiation there is not measured. The voltage follows the thickness; if the dose needs more current than the
/// limits permit, the voltage rises too. `filters`: aluminium and copper of the tube. Errors: those of the spectrum.
Result<Exposure> control_exposure(const MassImage& patient, const CArm& arm, const Tube& filters, DoseMode mode,
                                  double pulses_per_s, const ExposureLimits& limits, BeamCache& beams);

}  // namespace trocar::xray
