#pragma once

#include <array>
#include <functional>
#include <map>

#include "xray/geometry/c_arm.h"
#include "xray/physics/beam.h"
#include "xray/projection/xray_volume.h"

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

/// Pulses per second of pulsed fluoroscopy.
inline constexpr std::array<double, 3> kPulseRates_per_s{7.5, 15.0, 30.0};

/// Air kerma and photons fall with the square of the distance from the source. `at_1_m`: at 1000 mm.
double at_distance(double at_1_m, double distance_mm) noexcept;

/// Distance of the patient entrance reference point from the source: 150 mm before the isocentre (IEC 60601-2-43).
double reference_distance_mm(const CArm& arm) noexcept;

/// Irradiated area (cm²) of the collimated beam at a distance from the source.
double irradiated_area_cm2(const CArm& arm, double distance_mm) noexcept;

/// Dose indicators of an examination, summed over its pulses (docs/physics.md, X11).
struct Dose {
  double beam_on_s = 0.0;             ///< Time with the pedal down.
  double air_kerma_mgy = 0.0;         ///< At the reference point, without backscatter.
  double area_product_mgy_cm2 = 0.0;  ///< Air kerma times irradiated area, the same at every distance.
  int pulses = 0;
};

/// Adds pulses. `kerma_mgy_per_mas`: air kerma at 1 m (Beam::air_kerma_mgy); `mas`: of one pulse.
void add_pulses(int pulses, double mas, double kerma_mgy_per_mas, const CArm& arm, Dose& dose) noexcept;

}  // namespace trocar::xray
