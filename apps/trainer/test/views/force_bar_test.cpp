#include "views/plots/force_bar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/widget_actions.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// How far the colour reaches from the bar's beginning, as a share of its length.
double share(ForceBar& bar, const QRectF& area, const QColor& color) {
  const QImage image = bar.grab().toImage();
  const bool is_upright = area.height() > area.width();
  const double length = is_upright ? area.height() : area.width();
  double reached = 0.0;
  for (double along = 0.5; along < length; along += 1.0) {
    const QPointF at = is_upright ? QPointF(area.center().x(), area.bottom() - along)
                                  : QPointF(area.left() + along, area.center().y());
    const QPoint pixel(static_cast<int>(at.x()), static_cast<int>(at.y()));
    if (image.pixelColor(pixel) == color) reached = along;
  }
  return reached / length;
}

TEST(ForceBar, FillsInProportionToTheForce) {
  for (const Qt::Orientation orientation : {Qt::Vertical, Qt::Horizontal}) {
    ForceBar bar(orientation);
    bar.resize(orientation == Qt::Vertical ? QSize(60, 240) : QSize(360, 36));
    bar.set_scale(4.0, 10.0);
    bar.set_force(1.0, 0.0);
    bar.set_lag(5.0);
    constexpr double kPeakLine = 0.025;  // lies over the end of the bar
    EXPECT_NEAR(share(bar, bar.force_rect(), theme().good), 0.25, kPeakLine);
    EXPECT_NEAR(share(bar, bar.lag_rect(), theme().accent), 0.5, 0.01);
    bar.set_force(3.0, 0.1);
    EXPECT_NEAR(share(bar, bar.force_rect(), theme().warning), 0.75, kPeakLine);
    bar.set_force(9.0, 0.2);
    EXPECT_NEAR(share(bar, bar.force_rect(), theme().bad), 1.0, kPeakLine);
  }
}

TEST(ForceBar, HoldsThePeakThenReleasesIt) {
  ForceBar bar;
  bar.set_scale(4.0, 10.0);
  bar.set_force(2.0, 10.0);
  bar.set_force(0.5, 10.1);
  EXPECT_EQ(bar.force_n(), 0.5);
  EXPECT_EQ(bar.peak_n(), 2.0);
  bar.set_force(0.5, 11.4);
  EXPECT_EQ(bar.peak_n(), 2.0);
  bar.set_force(0.5, 11.7);
  EXPECT_EQ(bar.peak_n(), 0.5);
  bar.set_force(0.4, 0.0);  // A new start.
  EXPECT_EQ(bar.peak_n(), 0.4);
}

TEST(ForceBar, IgnoresNonFiniteValues) {
  ForceBar bar;
  bar.set_force(1.0, 0.0);
  bar.set_force(std::nan(""), 1.0);
  bar.set_lag(INFINITY);
  EXPECT_EQ(bar.force_n(), 1.0);
  EXPECT_EQ(bar.lag_mm(), 0.0);
}

TEST(ForceBar, RendersToAnImage) {
  QWidget window;
  window.resize(480, 240);
  ForceBar upright(Qt::Vertical, &window);
  upright.setGeometry(8, 8, 64, 224);
  ForceBar lying(Qt::Horizontal, &window);
  lying.setGeometry(90, 8, 380, 36);
  for (ForceBar* bar : {&upright, &lying}) {
    bar->set_scale(3.3, 20.0);
    bar->set_force(2.6, 0.0);
    bar->set_force(1.42, 0.2);
    bar->set_lag(7.4);
  }
  save(window, "force_bar.png");
  EXPECT_GT(share(lying, lying.force_rect(), theme().good), 0.3);
}

}  // namespace
}  // namespace trocar::trainer
