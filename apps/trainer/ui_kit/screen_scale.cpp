#include "ui_kit/screen_scale.h"

#include <QGuiApplication>
#include <QScreen>
#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

constexpr double kPlain_dpi = 96.0;
constexpr double kStep = 0.25;
constexpr QSizeF kUsual_px{1920, 1080};
/// Outside these limits the reported size is missing or wrong.
constexpr double kLeastPhysical_dpi = 60.0, kMostPhysical_dpi = 400.0;

double smaller_ratio(const QSizeF& size, const QSizeF& unit) {
  return std::min(size.width() / unit.width(), size.height() / unit.height());
}

ScreenFacts main_screen(int argc, char** argv) {
  const QGuiApplication looker(argc, argv);
  const QScreen* screen = QGuiApplication::primaryScreen();
  if (screen == nullptr) return {QSize(kSmallDesign)};
  const double ratio = screen->devicePixelRatio();
  return {screen->size() * ratio, screen->logicalDotsPerInch() * ratio, screen->physicalDotsPerInch() * ratio};
}

}  // namespace

double scale_of(const ScreenFacts& screen) {
  const bool is_told = screen.physical_dpi >= kLeastPhysical_dpi && screen.physical_dpi <= kMostPhysical_dpi;
  const double physical_dpi = is_told ? screen.physical_dpi : kPlain_dpi;
  const double wanted =
      std::max({screen.logical_dpi / kPlain_dpi, physical_dpi / kPlain_dpi, smaller_ratio(screen.size_px, kUsual_px)});
  const double most = smaller_ratio(screen.size_px, kSmallDesign);
  const double scale = std::min(wanted, most);
  constexpr double kRounding = 0.02;  // 191 dpi count as 192
  return std::max(1.0, kStep * std::floor(scale / kStep + kRounding / kStep));
}

void follow_screen(int argc, char** argv) {
  for (const char* own : {"QT_SCALE_FACTOR", "QT_SCREEN_SCALE_FACTORS", "QT_AUTO_SCREEN_SCALE_FACTOR",
                          "QT_ENABLE_HIGHDPI_SCALING", "QT_FONT_DPI"})
    if (qEnvironmentVariableIsSet(own)) return;
  const double scale = scale_of(main_screen(argc, argv));
  if (scale == 1.0) return;
  qputenv("QT_SCALE_FACTOR", QByteArray::number(scale));
  // Otherwise fonts would be scaled twice.
  qputenv("QT_FONT_DPI", QByteArray::number(kPlain_dpi));
}

}  // namespace trocar::trainer
