#pragma once

#include <memory>
#include <vector>

#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/probe/transducer.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {

/// Request to a live scanner: present poses of transducer and needle, and settings.
struct ScanRequest {
  Pose X_PT;                                 ///< Transducer in the patient now.
  motion::PatientMotion motion;              ///< Where the patient is; its model is that of the scene.
  std::vector<Vec3> needle_shaft_P;          ///< From the hub to the tip; fewer than two points: no needle.
  double needle_diameter_mm = 1.2;           ///< Range 0.2..5.
  double needle_bore_share = 0.0;            ///< See NeedleEcho::bore_share.
  double tip_shift_mm = 0.0;                 ///< See NeedleEcho::displacement_mm.
  Acquisition acquisition;                   ///< At full detail.
  std::shared_ptr<const Panorama> panorama;  ///< Engine: that of the panorama; nullptr: ray cast.
  /// Share of the scanlines that a picture renews while transducer or needle move, from one side to the other as in a
  /// scanner; 1: whole pictures. Range 0.05..1.
  double renewed_share = 1.0;
  DisplaySettings display;
  std::shared_ptr<const VesselFlow> flow;  ///< nullptr: no colour Doppler.
  DopplerSettings doppler;
  double time_s = 0.0;  ///< Time of heart and breath; must not decrease while one patient is scanned.
  int columns = 640;    ///< Size of the picture. Range 16..2048, like `rows`.
  int rows = 480;
};

/// Returns the request with every number clamped to its range; a number that is not finite is replaced by the
/// transducer's or the type's default. The focus is limited to the picture.
ScanRequest within_ranges(const ScanRequest& request, const Transducer& transducer);

/// True if a frame of `a` can also be displayed for `b`: same pose and patient within a hand's tremor (corners, needle
/// and tissue within `tolerance_mm`), same settings and size. Time is ignored.
bool is_equivalent(const ScanRequest& a, const ScanRequest& b, double tolerance_mm) noexcept;
/// True if the settings are the same.
bool has_same_settings(const ScanRequest& a, const ScanRequest& b) noexcept;

}  // namespace trocar::ultrasound
