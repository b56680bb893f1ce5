#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "cases/prescribed_motion.h"
#include "haptics/haptic_scene.h"

namespace trocar::cases {

/// Force on a device moved along a path, at one tick.
struct CurvePoint {
  double time_s = 0.0;
  double way_mm = 0.0;   ///< Device's tip past the resting skin, along the path.
  double tip_mm = 0.0;   ///< Depth of the virtual needle's tip: behind the device's by what tissue and coupling yield.
  double force_n = 0.0;  ///< On the device along the path; positive pushes the needle out.
  std::uint8_t tissue = 0;                 ///< At the needle's tip.
  std::uint8_t layer = haptics::kNoLayer;  ///< That gave way at this tick.
};

/// A punctured layer, measured at the device.
struct CurveEvent {
  std::string layer;
  std::size_t at = 0;      ///< Point of the peak.
  double way_mm = 0.0;     ///< Of the device.
  double peak_n = 0.0;     ///< Largest force just before it gave way.
  double highest_n = 0.0;  ///< From then to the lowest: above the peak where the force goes on rising, which is wrong.
  double after_n = 0.0;    ///< Lowest within kAfter_s, and before the next layer gives way.
  double fall_ms = 0.0;    ///< From the peak through nine tenths of the drop; 0 where nothing drops.

  double drop_n() const noexcept { return peak_n - after_n; }
};
inline constexpr double kAfter_s = 0.2;

/// Tissue along a path in the resting anatomy, pieces joined; by name of the label, else of the tissue.
struct PathPiece {
  double from_mm = 0.0, to_mm = 0.0;
  std::string name;    ///< "ligamentum_flavum"; the skin's shell is "skin".
  std::string tissue;  ///< Of the tissue table.
};

/// Moves the device along the path and beyond its end (after_mm) until the needle's tip reaches it: the tip lags
/// because of the compliance of tissue and coupling. Excludes the stylus' weight if the scene does.
std::vector<CurvePoint> force_curve(const haptics::HapticScene& scene, const PrescribedMotion& motion);
/// The layers that gave way, in order.
std::vector<CurveEvent> find_curve_events(const std::vector<CurvePoint>& curve, const anatomy::TissueTable& tissues);
/// From the skin to the path's end.
std::vector<PathPiece> pieces_along(const haptics::HapticScene& scene, const anatomy::TissueTable& tissues,
                                    const Segment& line_P);

}  // namespace trocar::cases
