#pragma once

#include <QSize>

namespace trocar::trainer {

/// As the screen reports them.
struct ScreenFacts {
  QSize size_px;
  double logical_dpi = 96.0;   ///< As set for the desktop.
  double physical_dpi = 96.0;  ///< From the reported size in mm, which may be wrong.
};

/// Factor of all sizes against 96 dpi, from the screen's resolution, in steps of a quarter, and so that a window of
/// kSmallDesign fits. At least 2 for 3840x2160: at 96 dpi such a screen is viewed from a larger distance.
double scale_of(const ScreenFacts& screen);
inline constexpr QSize kSmallDesign{1280, 800};

/// Sets Qt's scale to that of the main screen, unless the user's environment sets one of Qt's own variables. To be
/// called before the application is made; makes a temporary one to query the screen.
void follow_screen(int argc, char** argv);

}  // namespace trocar::trainer
