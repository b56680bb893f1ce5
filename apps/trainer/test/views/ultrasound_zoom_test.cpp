#include <cmath>

#include "test/views/ultrasound_lab.h"
#include "test/widget_actions.h"
#include "views/ultrasound/ultrasound_layout.h"
#include "views/ultrasound/ultrasound_painter.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

ultrasound::RasterGeometry some_raster(bool is_mirrored) {
  return {400, 300, 0.5, ultrasound::Vec2(is_mirrored ? 100.0 : -100.0, 0.0), is_mirrored};
}

TEST(PictureZoom, KeepsThePointUnderThePointer) {
  for (const bool is_mirrored : {false, true}) {
    const ultrasound::RasterGeometry raster = some_raster(is_mirrored);
    const QRectF target(20.0, 10.0, 800.0, 620.0);
    const PictureMap whole(target, raster);
    EXPECT_FALSE(whole.is_magnified());
    EXPECT_EQ(whole.rect(), whole.area());
    const QPointF place(500.0, 200.0);
    PictureMap map = whole;
    for (const double factor : {1.5, 2.0, 4.0, 3.0}) {
      const ultrasound::Vec2 before_T = map.to_T(place);
      map = PictureMap(target, raster, map.zoomed_at(place, factor));
      EXPECT_LT((map.to_T(place) - before_T).norm(), 1e-9) << factor;
      EXPECT_NEAR(map.pixels_per_mm(), factor * whole.pixels_per_mm(), 1e-9);
      EXPECT_EQ(map.area(), whole.area());
    }
  }
}

TEST(PictureZoom, TheAreaIsAlwaysFilled) {
  const ultrasound::RasterGeometry raster = some_raster(false);
  const QRectF target(0.0, 0.0, 800.0, 600.0);
  for (const QPointF& place : {QPointF(0, 0), QPointF(800, 600), QPointF(400, 300), QPointF(-50, 700)})
    for (const double factor : {1.0, 1.1, 2.7, 6.0, 100.0, 0.2}) {
      PictureMap map(target, raster);
      map = PictureMap(target, raster, map.zoomed_at(place, factor));
      EXPECT_TRUE(map.rect().adjusted(-1e-9, -1e-9, 1e-9, 1e-9).contains(map.area()));
      EXPECT_LE(map.pixels_per_mm(), kMostZoom * PictureMap(target, raster).pixels_per_mm() + 1e-9);
      map = PictureMap(target, raster, map.moved_by({5000.0, -5000.0}));
      EXPECT_TRUE(map.rect().adjusted(-1e-9, -1e-9, 1e-9, 1e-9).contains(map.area()));
    }
}

TEST_F(UltrasoundViewTest, CtrlWheelZoomsAtThePointerAndZeroResets) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  const PictureMap before = map_of(view);
  const QPointF at = before.area().center() + QPointF(60.0, -40.0);
  const ultrasound::Vec2 at_T = before.to_T(at);
  for (int n = 0; n < 4; ++n) wheel(view, at, 120, Qt::ControlModifier);
  const PictureMap after = map_of(view);
  EXPECT_NEAR(after.pixels_per_mm(), std::pow(1.15, 4) * before.pixels_per_mm(), 1e-6);
  EXPECT_LT((after.to_T(at) - at_T).norm(), 1e-6);
  look(view, "zoomed");
  view.setFocus();
  strike(view, Qt::Key_0);
  EXPECT_EQ(view.zoom(), PictureZoom());
  wheel(view, at, 120);  // without Ctrl it is for the tools
  EXPECT_EQ(view.zoom(), PictureZoom());
}

TEST_F(UltrasoundViewTest, MeasuredDistanceIsIndependentOfTheZoom) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  const ultrasound::Vec2 a_T(-10.0, 60.0), b_T(20.0, 100.0);  // 50 mm apart
  for (const double factor : {1.0, 1.3}) {
    view.zoom_at(map_of(view).to_view(0.5 * (a_T + b_T)), factor);
    view.clear_measurements();
    view.start_measuring(MeasuringTool::kDistance);
    drag(view, map_of(view).to_view(a_T), map_of(view).to_view(b_T), Qt::LeftButton);
    ASSERT_EQ(view.measurements().items().size(), 1U);
    const auto& caliper = std::get<ultrasound::DistanceCaliper>(view.measurements().items().front());
    EXPECT_NEAR(caliper.distance_mm(), 50.0, 1.0) << factor;  // marks are set at whole pixels
  }
}

TEST_F(UltrasoundViewTest, UpdatesTheResultWhileACaliperIsDrawn) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  const PictureMap map = map_of(view);
  EXPECT_TRUE(view.live_result().isEmpty());
  view.start_measuring(MeasuringTool::kDistance);
  EXPECT_TRUE(view.live_result().isEmpty()) << "no mark yet";
  const QPointF from = map.to_view({0.0, 50.0});
  trainer::mouse(view, QEvent::MouseButtonPress, from, Qt::LeftButton);
  for (const double mm : {20.0, 35.0}) {
    trainer::mouse(view, QEvent::MouseMove, map.to_view({0.0, 50.0 + mm}), Qt::LeftButton);
    const QString text = view.live_result();
    ASSERT_TRUE(text.startsWith(QStringLiteral("Dist "))) << text.toStdString();
    EXPECT_NEAR(text.section(QLatin1Char(' '), 1, 1).toDouble(), mm, 0.8);
  }
  look(view, "live_caliper");
  trainer::mouse(view, QEvent::MouseButtonRelease, map.to_view({0.0, 85.0}), Qt::LeftButton);
  EXPECT_TRUE(view.live_result().isEmpty()) << "it is in the caption now";
  view.start_measuring(MeasuringTool::kAngle);
  trainer::mouse(view, QEvent::MouseButtonPress, from, Qt::LeftButton);
  trainer::mouse(view, QEvent::MouseButtonRelease, from, Qt::LeftButton);
  EXPECT_TRUE(view.live_result().isEmpty()) << "one arm is no angle";
}

TEST_F(UltrasoundViewTest, CaptionShowsMechanicalAndThermalIndices) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  const auto output = ultrasound::load_acoustic_output(data_dir() / "transducers.toml", "C5-2");
  ASSERT_TRUE(output);
  const auto shown = [&] {
    const CaptionFacts facts{QStringLiteral("C5-2"), 30.0, {}, {}, false, *output};
    for (const CaptionLine& line : caption_of(*view.picture(), facts))
      if (line.text.startsWith(QStringLiteral("MI "))) return line.text;
    return QString();
  };
  const double before = shown().section(QLatin1Char(' '), 1, 1).toDouble();
  EXPECT_GT(before, 0.2);
  EXPECT_LE(before, 1.9);
  // A deeper focus: more tissue derates the pressure.
  view.change_settings([](UltrasoundSettings& s) { s.acquisition.focus_mm = 20.0; });
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.acquisition.focus_mm == 20.0; }));
  EXPECT_GT(shown().section(QLatin1Char(' '), 1, 1).toDouble(), before);
  const CaptionFacts small{QStringLiteral("C5-2"), 30.0, {}, {}, true, *output};
  bool has_it = false;
  for (const CaptionLine& line : caption_of(*view.picture(), small))
    has_it |= line.text.contains(QStringLiteral("MI "));
  EXPECT_TRUE(has_it) << "in a small view, too";
}

}  // namespace
}  // namespace trocar::trainer
