#pragma once

#include <QSize>

namespace trocar::trainer {

/// Properties reported by the screen.
struct ScreenFacts {
  QSize size_px;
  double logical_dpi = 96.0;   ///< Desktop setting.
  double physical_dpi = 96.0;  ///< From the reported size in mm, which may be incorrect.
};

/// Scale factor of all sizes relative to 96 dpi, from the screen's resolution, in steps of a quarter, such that a
/// window of kSmallDesign fits. At least 2 for 3840x2160: at 96 dpi such a screen is viewed from a larger distance.
double scale_of(const ScreenFacts& screen);
inline constexpr QSize kSmallDesign{1280, 800};

/// Sets Qt's scale to that of the main screen, unless the environment sets one of Qt's scale variables. Call it before
/// the application is created; it creates a temporary application to query the screen.
void follow_screen(int argc, char** argv);

}  // namespace trocar::trainer
