#pragma once

namespace trocar::scene {

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

}  // namespace trocar::scene
