#include "views/plots/force_plot.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QToolButton>
#include <cmath>

#include "core/random.h"
#include "test/widget_actions.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// A needle that goes in at 10 mm/s with a puncture at 20 mm, samples 1 ms apart, rests there and trembles.
std::vector<ForcePoint> insertion(double seconds) {
  std::vector<ForcePoint> points;
  for (int n = 0; n < static_cast<int>(1000.0 * seconds); ++n) {
    const double time_s = 0.001 * n;
    const double depth_mm = std::min(10.0 * time_s, 60.0) + 0.2 * std::sin(60.0 * time_s);
    const double elastic_n = depth_mm < 20.0 ? 0.15 * std::max(depth_mm, 0.0) : 0.02 * depth_mm;
    points.push_back({time_s, depth_mm, elastic_n + 0.02 * std::sin(300.0 * time_s)});
  }
  return points;
}

std::vector<ForcePlot::Band> bands() {
  return {{0.0, 2.0, "skin", QColor(0xd8, 0xa0, 0x80)},
          {2.0, 18.0, "fat", QColor(0xe0, 0xd0, 0x70)},
          {18.0, 30.0, "muscle", QColor(0xa0, 0x40, 0x40)},
          {30.0, 90.0, "liver", QColor(0x90, 0x50, 0x30)}};
}

struct ShownPlot {
  ShownPlot() {
    plot.resize(420, 260);
    plot.show();
    QCoreApplication::processEvents();
  }
  QColor color_at(const QPointF& at) {
    return plot.grab().toImage().pixelColor((at * plot.devicePixelRatioF()).toPoint());
  }
  ForcePlot plot;
};

TEST(CurveTrace, KeepsEveryPeakAndFewPoints) {
  Random random(5);
  CurveTrace trace;
  trace.set_column_width(0.5);
  constexpr std::size_t kCount = 60000;
  std::vector<std::size_t> peaks;
  for (std::size_t n = 0; n < kCount; ++n) {
    const bool is_peak = n % 1777 == 900;
    if (is_peak) peaks.push_back(n);
    trace.append({static_cast<double>(n) * 0.005, (is_peak ? 50.0 : 0.0) + random.uniform()});
  }
  const std::vector<std::size_t> drawn = trace.drawn(kCount);
  EXPECT_LE(drawn.size(), 4 * 601U);  // 300 of x in columns of 0.5
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
  EXPECT_EQ(drawn.front(), 0U);
  EXPECT_EQ(drawn.back(), kCount - 1);
  for (const std::size_t peak : peaks) EXPECT_TRUE(std::binary_search(drawn.begin(), drawn.end(), peak)) << peak;
}

TEST(CurveTrace, ThinsIndependentlyOfEarlierWidths) {
  CurveTrace grown, rewidened;
  grown.set_column_width(2.0);
  rewidened.set_column_width(0.1);
  Random random(6);
  double x = 0.0;
  for (int n = 0; n < 5000; ++n) {
    x += random.uniform(-0.1, 0.12);
    const QPointF point(x, random.uniform());
    grown.append(point);
    rewidened.append(point);
  }
  rewidened.set_column_width(2.0);
  EXPECT_EQ(grown.drawn(5000), rewidened.drawn(5000));
  EXPECT_EQ(grown.drawn(2500).back(), 2499U);
}

TEST(CurveTrace, TremorAddsNoDrawnPoints) {
  CurveTrace trace;
  trace.set_column_width(0.5);
  for (int n = 0; n < 100000; ++n) trace.append({30.0 + 0.2 * std::sin(0.06 * n), std::cos(0.3 * n)});
  EXPECT_LE(trace.drawn(100000).size(), 4U);
}

TEST(ForcePlot, DrawsTheCurveWhereItsValuesLie) {
  ShownPlot shown;
  shown.plot.set_bands(bands());
  shown.plot.append(insertion(6.0));
  const PlotFrame frame = shown.plot.frame();
  EXPECT_EQ(frame.x.low, 0.0);
  EXPECT_GE(frame.x.high, 90.0);
  EXPECT_GE(frame.y.high, 3.0);
  const QImage image = shown.plot.grab().toImage();
  for (const double depth_mm : {8.0, 15.0, 45.0}) {
    const double force_n = depth_mm < 20.0 ? 0.15 * depth_mm : 0.02 * depth_mm;
    const QPoint at = frame.to_point({depth_mm, force_n}).toPoint();
    bool is_there = false;
    for (int dy = -3; dy <= 3; ++dy) {
      const QColor color = image.pixelColor(at + QPoint(0, dy));
      is_there |= color.blue() > 150 && color.red() < 130;
    }
    EXPECT_TRUE(is_there) << depth_mm;
  }
  const QPointF in_liver = frame.to_point({80.0, 0.0});
  EXPECT_EQ(image.pixelColor(QPointF(in_liver.x(), frame.area.bottom() + 3.0).toPoint()), bands().back().color);
}

TEST(ForcePlot, AxesOnlyGrow) {
  ShownPlot shown;
  double last_n = 0.0;
  int changes = 0;
  for (const ForcePoint& point : insertion(12.0)) {
    shown.plot.append({&point, 1});
    const PlotFrame frame = shown.plot.frame();
    EXPECT_GE(frame.y.high, last_n);
    EXPECT_GE(frame.y.high, point.resistance_n);
    changes += frame.y.high != last_n ? 1 : 0;
    last_n = frame.y.high;
  }
  EXPECT_LE(changes, 6);
  shown.plot.clear();
  EXPECT_LT(shown.plot.frame().y.high, last_n);
}

TEST(ForcePlot, SwitchesToTimeByKeyAndButton) {
  ShownPlot shown;
  shown.plot.append(insertion(12.0));
  press_key(shown.plot, Qt::Key_T);
  EXPECT_EQ(shown.plot.axis(), ForcePlot::Axis::kTime);
  EXPECT_EQ(shown.plot.frame().x.high, 20.0);
  shown.plot.findChild<QToolButton*>("force-plot-axis")->click();
  EXPECT_EQ(shown.plot.axis(), ForcePlot::Axis::kDepth);
}

TEST(ForcePlot, MovesTheCursorToATime) {
  ShownPlot shown;
  EXPECT_FALSE(shown.plot.current().has_value());
  shown.plot.append(insertion(6.0));
  EXPECT_NEAR(shown.plot.current()->time_s, 5.999, 1e-9);
  shown.plot.set_cursor(2.0005);
  EXPECT_NEAR(shown.plot.current()->time_s, 2.0, 1e-9);
  const PlotFrame frame = shown.plot.frame();
  const auto now = *shown.plot.current();
  EXPECT_GT(shown.color_at(frame.to_point({now.depth_mm, now.resistance_n})).red(), 200);  // the mark
  shown.plot.set_cursor(-1.0);
  EXPECT_FALSE(shown.plot.current().has_value());
}

TEST(ForcePlot, SkipsNonFiniteValues) {
  ShownPlot shown;
  const double nan = std::nan("");
  const std::vector<ForcePoint> points{{0.0, nan, 1.0}, {0.1, 1.0, INFINITY}, {nan, 1.0, 1.0}, {0.2, 5.0, 0.5}};
  shown.plot.append(points);
  shown.plot.set_predicted({{0.0, nan}, {INFINITY, 1.0}, {10.0, 0.7}});
  EXPECT_EQ(shown.plot.current()->depth_mm, 5.0);
  EXPECT_DOUBLE_EQ(shown.plot.frame().y.high, 1.2);
}

TEST(ForcePlot, MarksPuncturesWithTheirNames) {
  ShownPlot shown;
  const QPointF on_line = shown.plot.frame().to_point({10.0, 0.2});
  const int column = static_cast<int>(on_line.x());
  const QImage before = shown.plot.grab().toImage();
  shown.plot.add_event(10.0, 1.0, "skin");
  const QImage after = shown.plot.grab().toImage();
  int marked = 0, named = 0;
  for (int y = 30; y < 220; ++y) {
    marked += before.pixelColor(column, y) != after.pixelColor(column, y) ? 1 : 0;
    for (int x = 5; x < 30; ++x) {
      const QColor color = after.pixelColor(column + x, y);
      named += color.red() > 180 && color.blue() < 120 ? 1 : 0;
    }
  }
  EXPECT_GT(marked, 50);
  EXPECT_GT(named, 10);
}

TEST(ForcePlot, RendersToAnImage) {
  QWidget window;
  window.resize(700, 520);
  const QRect places[] = {{0, 0, 420, 260}, {430, 0, 260, 180}, {0, 265, 420, 250}, {430, 265, 220, 140}};
  std::vector<std::unique_ptr<ForcePlot>> plots;
  for (const QRect& place : places) {
    auto plot = std::make_unique<ForcePlot>(&window);
    plot->setGeometry(place);
    plot->set_bands(bands());
    plot->set_predicted({{0, 0}, {2, 0.4}, {19, 2.6}, {19.5, 0.4}, {30, 0.7}, {31, 1.5}, {32, 0.8}, {90, 2.1}});
    plot->set_reference({{0, 0}, {2, 0.5}, {20, 2.8}, {20.5, 0.5}, {60, 1.3}});
    plot->append(insertion(9.0));
    plot->add_event(2.0, 0.2, "skin");
    plot->add_event(20.0, 2.0, "muscle");
    plot->add_event(31.0, 3.1, "liver capsule");
    plots.push_back(std::move(plot));
  }
  plots[1]->set_cursor(3.0);
  plots[2]->set_axis(ForcePlot::Axis::kTime);
  window.show();
  QCoreApplication::processEvents();
  save(window, "force_plot.png");
  const QImage image = window.grab().toImage();
  for (const auto& plot : plots) EXPECT_EQ(image.pixelColor(plot->pos() + QPoint(1, 1)), theme().panel);
}

TEST(ForcePlot, HidesDepthWhenDepthIsNotShown) {
  ShownPlot shown;
  shown.plot.append(insertion(5.0));
  shown.plot.add_event(20.0, 2.0, QStringLiteral("shot"));
  EXPECT_TRUE(shown.plot.figures_text().contains(QStringLiteral("mm")));
  shown.plot.set_depth_shown(false);
  EXPECT_EQ(shown.plot.axis(), ForcePlot::Axis::kTime);
  EXPECT_FALSE(shown.plot.figures_text().contains(QStringLiteral("mm")));
  press_key(shown.plot, Qt::Key_T);
  shown.plot.findChild<QToolButton*>(QStringLiteral("force-plot-axis"))->click();
  shown.plot.set_axis(ForcePlot::Axis::kDepth);
  EXPECT_EQ(shown.plot.axis(), ForcePlot::Axis::kTime);
  const QRectF area = shown.plot.frame().area;
  const QPointF at = shown.plot.frame().to_point({2.0, 0.0});
  EXPECT_FALSE(shown.plot.text_at(at.toPoint()).contains(QStringLiteral("mm")));
  EXPECT_FALSE(shown.plot.text_at(area.center().toPoint()).contains(QStringLiteral("mm")));
  shown.plot.set_depth_shown(true);
  EXPECT_EQ(shown.plot.axis(), ForcePlot::Axis::kDepth);
}

}  // namespace
}  // namespace trocar::trainer
