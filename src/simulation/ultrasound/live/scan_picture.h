#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/live/live_schedule.h"
#include "geometry/pose.h"
#include "image/image.h"
#include "motion/patient_motion.h"
#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/probe/transducer.h"
#include "ultrasound/scanner/display_settings.h"
#include "ultrasound/scanner/scanner.h"

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

/// Level of detail of a frame, relative to the requested acquisition.
enum class ScanDetail { kFast, kMiddle, kFull };
inline constexpr std::size_t kScanDetails = 3;

/// Reduces scanlines, samples, elevation planes, steering angles and scatterers to a level; never finer than `full`.
/// Other settings stay the same, and so does the pattern of the speckle.
Acquisition with_detail(const Acquisition& full, ScanDetail detail) noexcept;

/// Times of a live ultrasound image.
struct ScanPace {
  LivePace live{.moving_ms = 40.0};  ///< 25 pictures a second, as a scanner.
  double refresh_s = 0.1;            ///< Time between frames in which only noise changes. Range 0.02..2.
  double doppler_s = 0.05;           ///< The same with colour Doppler, whose picture follows the pulse.
  double tremor_mm = 0.05;           ///< Smaller movements of transducer and needle count as rest. Range 0..1.
};

/// Requests and levels of detail of ultrasound for LiveSchedule.
class ScanLevels {
 public:
  using Request = ScanRequest;
  using Level = ScanDetail;
  static constexpr std::size_t kLevels = kScanDetails;

  ScanLevels() = default;
  explicit ScanLevels(const ScanPace& pace) : pace_(pace) {}

  LivePace pace() const noexcept { return pace_.live; }
  bool is_same(const ScanRequest& a, const ScanRequest& b) const noexcept {
    return is_equivalent(a, b, pace_.tremor_mm);
  }
  /// Work of a frame in samples.
  double work(const ScanRequest& request, ScanDetail detail) const noexcept;
  double refresh_s(const ScanRequest& request) const noexcept {
    return request.flow ? pace_.doppler_s : pace_.refresh_s;
  }

 private:
  ScanPace pace_;
};

/// While transducer, needle or settings change: the finest detail whose time stays within the pace. At rest: full
/// detail, then periodic refreshes.
using ScanSchedule = LiveSchedule<ScanLevels>;

/// A finished picture of a live scanner with the data for drawing it, measuring in it and placing it in a 3D view.
/// Immutable once it is shared.
struct ScanPicture {
  std::uint64_t number = 0;  ///< Increases by one with each picture of a scanner.
  image::GrayImage gray;
  image::RgbImage colour;  ///< Picture with Doppler colours and box; empty without Doppler.
  RasterGeometry raster;
  ScanGeometry scan;
  Pose X_PT;            ///< Pose of the transducer for this picture.
  double time_s = 0.0;  ///< Time of the request for this picture.
  /// Outer corners of the picture (edges of its pixels): top left, top right, bottom left. Frame P, mm.
  std::array<Vec3, 3> corners_P{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::vector<std::uint8_t> levels;  ///< Levels of `scan`, see Scanner::levels().
  Acquisition acquisition;           ///< As requested, at full detail.
  DisplaySettings display;
  ScanDetail detail = ScanDetail::kFull;
  double took_ms = 0.0;                 ///< Computation time.
  double coupled_share = 1.0;           ///< Coupled share of the face, 0..1.
  double panorama_share = 0.0;          ///< Share of the picture that comes from a panorama, 0..1; 0: ray cast.
  double doppler_scale_cm_per_s = 0.0;  ///< Scale in use; 0 without Doppler.
  DopplerSettings doppler;
  bool is_frozen = false;        ///< True for a picture from the cine loop.
  int cine_position = -1;        ///< Index of the frame in the cine loop; the oldest is 0.
  int cine_size = 0;             ///< Frames in the cine loop.
  double unscanned_share = 0.0;  ///< Share of the picture beyond the ends of the CT (scan_ends.h), 0..1.
  std::vector<Vec2> scanned_T;   ///< Polygon of the image plane within the ends; empty: nothing was scanned.
  /// Depth of the dent in the skin on each scanline, and depth to which tissue yields (probe_contact.h).
  std::vector<float> pressed_mm;
  double dent_reach_mm = 40.0;
};

/// Position in the picture (x, y of T) of a point of the resting patient, with the skin dented by the face. The point's
/// distance from the plane is ignored.
Vec2 shown_place_T(const ScanPicture& picture, const Vec3& p_P) noexcept;

/// Resamples the levels of one scan to another of the same fan and depth, by interpolation. The size of `to` must match
/// `to_scan`.
void resample_levels(std::span<const std::uint8_t> from, const ScanGeometry& from_scan, const ScanGeometry& to_scan,
                     std::vector<std::uint8_t>& to);

}  // namespace trocar::ultrasound
