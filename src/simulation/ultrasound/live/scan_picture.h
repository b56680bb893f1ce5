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

/// A finished picture of a live scanner with all that is needed to draw it, measure in it and lay it into a 3D view.
/// Immutable once it is shared.
struct ScanPicture {
  std::uint64_t number = 0;  ///< Grows by one with each picture of a scanner.
  GrayImage gray;
  volume::RgbImage colour;  ///< With Doppler's colours and box; empty without.
  RasterGeometry raster;
  ScanGeometry scan;
  Pose X_PT;            ///< Where it was made.
  double time_s = 0.0;  ///< Of the request that it was made for.
  /// Outer corners of the picture (edges of its pixels): top left, top right, bottom left. Frame P, mm.
  std::array<Vec3, 3> corners_P{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::vector<std::uint8_t> levels;  ///< As Scanner::levels(), of `scan`.
  Acquisition acquisition;           ///< As asked for, at full detail.
  DisplaySettings display;
  ScanDetail detail = ScanDetail::kFull;
  double took_ms = 0.0;                 ///< To make it.
  double coupled_share = 1.0;           ///< Of the face, 0..1.
  double doppler_scale_cm_per_s = 0.0;  ///< In use; 0 without Doppler.
  DopplerSettings doppler;
  bool is_frozen = false;        ///< From the cine loop.
  int cine_position = -1;        ///< Of the frame in the cine loop, from the oldest, 0.
  int cine_size = 0;             ///< Frames in the cine loop.
  double unscanned_share = 0.0;  ///< Of the picture, beyond the ends of the CT (scan_ends.h), 0..1.
  std::vector<Vec2> scanned_T;   ///< The polygon of the image plane within the ends; empty: nothing.
  /// How far the face dents the skin on each scanline, and how deep tissue yields (probe_contact.h).
  std::vector<float> pressed_mm;
  double dent_reach_mm = 40.0;
};

/// Where in the picture (x, y of T) a point of the resting patient appears, under the face that presses the skin in.
/// Its distance from the plane is left out.
Vec2 shown_place_T(const ScanPicture& picture, const Vec3& p_P) noexcept;

/// Levels of one scan as another of the same fan and depth would have them, interpolated. `to` as long as its scan
/// says.
void resample_levels(std::span<const std::uint8_t> from, const ScanGeometry& from_scan, const ScanGeometry& to_scan,
                     std::vector<std::uint8_t>& to);

}  // namespace trocar::ultrasound
