#include "ui_kit/theme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

/// Relative luminance and contrast as WCAG 2.1 defines them.
double luminance(const QColor& color) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}

double contrast(const QColor& a, const QColor& b) {
  const double x = luminance(a) + 0.05, y = luminance(b) + 0.05;
  return std::max(x, y) / std::min(x, y);
}

TEST(Theme, TextIsLegibleOnEveryBackground) {
  const Theme& t = theme();
  for (const QColor& ground : {t.ground, t.view, t.panel, t.raised})
    for (const QColor& text : {t.text, t.dim, t.accent, t.good, t.warning, t.bad}) {
      EXPECT_GE(contrast(text, ground), 4.5) << text.name().toStdString() << " on " << ground.name().toStdString();
    }
}

}  // namespace
}  // namespace trocar::trainer
