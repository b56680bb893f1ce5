#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/pose.h"
#include "ultrasound/live/scan_request.h"
#include "ultrasound/live/scan_schedule.h"
#include "ultrasound/scanner/scanner.h"
#include "volume/image.h"

namespace trocar::ultrasound {

/// A finished picture of a live scanner with the data for drawing it, measuring in it and placing it in a 3D view.
/// Immutable once it is shared.
struct ScanPicture {
  std::uint64_t number = 0;  ///< Increases by one with each picture of a scanner.
  GrayImage gray;
  volume::RgbImage colour;  ///< Picture with Doppler colours and box; empty without Doppler.
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
