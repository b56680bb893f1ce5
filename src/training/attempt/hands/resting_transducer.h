#pragma once

#include "anatomy/patient.h"
#include "geometry/segment.h"
#include "link/messages.h"

namespace trocar::attempt {

/// Simulated hand with the transducer on the skin near a needle's entry: presses down a few mm and stays, with tremor.
/// A function of time only. Frame P.
class ProbeHand {
 public:
  /// Beside path_P.a, towards head or feet, where the skin is flatter.
  ProbeHand(const anatomy::VirtualPatient& patient, const Segment& path_P) noexcept;

  /// Target pose of the transducer `time_s` after the forces were switched on; without server_time_s.
  link::HandTarget at(double time_s) const noexcept;
  /// Room in the patient: where the grip is at rest, so that the device's workspace is about it.
  Pose room(const Pose& X_PW_of_needle) const noexcept;

  static constexpr double kBeside_mm = 40.0;  ///< From the entry, along the skin's tangent; a needle needs its place.
  static constexpr double kPress_mm = 4.0;    ///< Beyond the resting skin. [assumed] 2.4 N at the hand's 0.6 N/mm
  static constexpr double kAbove_mm = 10.0;   ///< Where it begins.

 private:
  Pose X_PT_skin_;  ///< On the resting skin.
};

/// Room of a transducer in the patient: turned as the needle's, with the grip at its origin where it is held at X_PT.
Pose probe_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept;

}  // namespace trocar::attempt
