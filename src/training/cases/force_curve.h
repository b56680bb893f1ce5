#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "haptics/haptic_scene.h"
#include "haptics/tick.h"

namespace trocar::cases {

/// Moves a device along a needle path at constant speed, independent of forces (open loop), so that two scenes get the
/// same poses: from `before_mm` outside the skin to the path's end, with smooth drift and tilt inside the body, which
/// exercise the path constraint and the shaft.
struct PrescribedMotion {
  Segment line_P{Vec3::Zero(), Vec3::Zero()};  ///< Skin -> target.
  double speed_mm_per_s = 10.0;                ///< Range 0.1..500.
  double dt_s = 0.001;
  double before_mm = 10.0;
  double after_mm = 0.0;           ///< Distance straight on past the path's end.
  Vec3 drift_P = Vec3::Zero();     ///< Drift of the tip at the path's end, across the path.
  Vec3 tilt_rad_P = Vec3::Zero();  ///< Rotation vector about the tip at the path's end.
};

int tick_count(const PrescribedMotion& motion) noexcept;
/// Position of the tip along the path at a tick (1 = the first), mm; negative outside the skin.
double way_mm(const PrescribedMotion& motion, int tick) noexcept;
/// Input from the device to the scene at that tick.
haptics::HapticInput input_at(const PrescribedMotion& motion, int tick) noexcept;

/// Force on a device moved along a path, at one tick.
struct CurvePoint {
  double time_s = 0.0;
  double way_mm = 0.0;  ///< Distance of the device's tip past the resting skin, along the path.
  double tip_mm = 0.0;  ///< Depth of the virtual needle's tip: behind the device's by the yield of tissue and coupling.
  double force_n = 0.0;                    ///< Force on the device along the path; positive pushes the needle out.
  std::uint8_t tissue = 0;                 ///< Tissue at the needle's tip.
  std::uint8_t layer = haptics::kNoLayer;  ///< Layer punctured at this tick.
};

/// A punctured layer, measured at the device.
struct CurveEvent {
  std::string layer;
  std::size_t at = 0;      ///< Index of the peak in the curve.
  double way_mm = 0.0;     ///< Position of the device along the path.
  double tip_mm = 0.0;     ///< Depth of the virtual needle's tip, held by the layer that gives way.
  double peak_n = 0.0;     ///< Largest force just before the puncture.
  double highest_n = 0.0;  ///< Largest force from the peak to the minimum; above peak_n if the force continues to rise,
                           ///< which is wrong.
  double after_n = 0.0;    ///< Lowest force within kAfter_s and before the next puncture.
  double fall_ms = 0.0;    ///< Time from the peak through 90 % of the drop; 0 without a drop.

  double drop_n() const noexcept { return peak_n - after_n; }
};
inline constexpr double kAfter_s = 0.2;

/// A piece of tissue along a path in the resting anatomy; adjacent pieces are joined. The name is the label's,
/// otherwise the tissue's.
struct PathPiece {
  double from_mm = 0.0, to_mm = 0.0;
  std::string name;    ///< "ligamentum_flavum"; the skin's shell is "skin".
  std::string tissue;  ///< Name in the tissue table.
};

/// A border between tissues at which the force has a peak without a puncture: a border of the CT.
struct CurveBorder {
  std::string name;     ///< Label or tissue behind it.
  double at_mm = 0.0;   ///< Its place on the path at rest.
  double tip_mm = 0.0;  ///< Place of the needle's tip at the peak.
  double peak_n = 0.0;
};
/// From 3 mm before a border to 10 mm behind it, or to the next; a peak stands out by a fifth of a newton.
std::vector<CurveBorder> find_curve_borders(const std::vector<CurvePoint>& curve, const std::vector<PathPiece>& pieces);

/// Moves the device along the path and beyond its end (after_mm) until the needle's tip reaches it: the tip lags
/// because of the compliance of tissue and coupling. Excludes the stylus' weight if the scene does.
std::vector<CurvePoint> force_curve(const haptics::HapticScene& scene, const PrescribedMotion& motion);
/// Punctured layers, in order.
std::vector<CurveEvent> find_curve_events(const std::vector<CurvePoint>& curve, const anatomy::TissueTable& tissues);
/// Tissue from the skin to the path's end.
std::vector<PathPiece> pieces_along(const haptics::HapticScene& scene, const anatomy::TissueTable& tissues,
                                    const Segment& line_P);

}  // namespace trocar::cases
