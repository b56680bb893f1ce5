#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/vec.h"
#include "image/image.h"

namespace trocar::scene {

/// Amount of a plan that the views of a case show.
enum class Guidance {
  kNone,    ///< No guidance, and no lesions of the segmentation: the trainee must find them in the images.
  kTarget,  ///< The target and the entry zone.
  kPath,    ///< Also the expert's path between them.
};

/// CT planes along the needle, with their visibility.
struct MprOptions {
  bool has_long_plane = false;   ///< Through the needle's axis, as near to axial as possible.
  bool has_cross_plane = false;  ///< Through the axis, perpendicular to the long plane.
  bool has_tip_plane = false;    ///< Perpendicular to the axis, at the tip.
  double level_hu = 50.0;        ///< Middle grey. Range -1000..3000.
  double window_hu = 400.0;      ///< From black to white. Range 1..4000.
  double size_mm = 160.0;        ///< Edge of a plane. Range 20..600.
  bool operator==(const MprOptions&) const = default;
};

enum class StereoMode {
  kOff,
  kQuadBuffer,  ///< Shutter glasses: one image per eye, for a screen that alternates them.
  kAnaglyph,    ///< Red-cyan glasses.
  kSideBySide,
  kInterlaced,  ///< Even rows to one eye, odd ones to the other.
};

enum class Eye { kLeft, kRight };

struct StereoOptions {
  StereoMode mode = StereoMode::kOff;
  double eye_angle_deg = 2.0;  ///< Between the lines of sight of both eyes at the focus. Range 0..10.
  double focus_shift = 0.0;    ///< Moves the plane without parallax nearer (below 0) or farther, share of the distance.
                               ///< Range -0.5..1.
  bool swaps_eyes = false;
  bool is_mirrored_left_right = false;  ///< For a monitor that is viewed through a mirror.
  bool is_mirrored_up_down = false;
  bool operator==(const StereoOptions&) const = default;
};

/// Preset of the CT volume rendering.
enum class VolumePreset { kNone, kBone, kSoftTissue, kVessels, kSkinAndBone };

/// A point of a transfer function, which is linear between points and constant outside.
struct TransferPoint {
  double hu;
  image::Rgb color;
  double opacity;  ///< Opacity of a path of 1 mm, 0..1.
};

/// Points by rising HU; empty for kNone.
std::span<const TransferPoint> transfer_function(VolumePreset preset) noexcept;

}  // namespace trocar::scene
