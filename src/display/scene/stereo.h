#pragma once

namespace trocar::scene {

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

}  // namespace trocar::scene
