#include "views/ultrasound/ultrasound_view.h"

#include <cmath>
#include <numbers>

#include "test/views/ultrasound_lab.h"
#include "views/slices/slice_view.h"
#include "views/ultrasound/ultrasound_layout.h"
#include "views/ultrasound/ultrasound_painter.h"

namespace trocar::trainer {
namespace {

double mean_gray(const QImage& image, const QPointF& middle, int half) {
  double sum = 0.0;
  int count = 0;
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x, ++count) sum += qGray(image.pixel(middle.toPoint() + QPoint(x, y)));
  return sum / count;
}

int coloured(const QImage& image, const QRect& within) {
  int count = 0;
  for (int y = within.top(); y <= within.bottom(); ++y)
    for (int x = within.left(); x <= within.right(); ++x) {
      const QColor c = image.pixelColor(x, y);
      const int most = std::max({c.red(), c.green(), c.blue()}), least = std::min({c.red(), c.green(), c.blue()});
      count += most > 90 && most - least > 80 && c.green() < most ? 1 : 0;
    }
  return count;
}

TEST_F(UltrasoundViewTest, FanIsBrightInTissueAndBlackOutside) {
  for (const QSize size : {QSize(480, 420), QSize(900, 700), QSize(240, 180)}) {
    UltrasoundView view;
    open(view, "liver-right-kidney", size);
    ASSERT_TRUE(settle(view));
    const QImage image = look(view, qPrintable(QStringLiteral("liver_%1").arg(size.width())));
    const PictureMap map = map_of(view);
    const ultrasound::ScanGeometry& scan = view.picture()->scan;
    const double middle = scan.middle_line();
    EXPECT_GT(mean_gray(image, map.to_view(scan.to_cartesian({middle, 50.0})), 12), 25.0);
    for (const double line : {-6.0, scan.lines + 5.0})
      for (const double share : {0.35, 0.6, 0.9})
        EXPECT_EQ(mean_gray(image, map.to_view(scan.to_cartesian({line, share * scan.depth_mm})), 0), 0.0)
            << line << " " << share;
    // The picture uses the room that it has.
    EXPECT_GT(map.pixels_per_mm() * scan.depth_mm, 0.6 * size.height());
  }
}

/// Straight, from the skin beside the face to 70 mm depth, in the plane moved by `beside_mm`.
std::vector<Vec3> needle_in_plane(const Pose& X_PT, double beside_mm) {
  return {X_PT * Vec3(50.0, -10.0, beside_mm), X_PT * Vec3(-5.0, 70.0, beside_mm)};
}

/// Mean of the brightest pixels beside the shaft's middle third: lines across it.
double brightness_along(const QImage& image, const UltrasoundView& view, const std::vector<Vec3>& shaft_P) {
  const PictureMap map = map_of(view);
  double sum = 0.0;
  constexpr int kPlaces = 20;
  for (int n = 0; n < kPlaces; ++n) {
    const double share = 0.6 + 0.35 * n / kPlaces;
    const QPointF at =
        map.to_view(ultrasound::shown_place_T(*view.picture(), shaft_P[0] + share * (shaft_P[1] - shaft_P[0])));
    int most = 0;
    for (int y = -4; y <= 4; ++y) most = std::max(most, qGray(image.pixel(at.toPoint() + QPoint(0, y))));
    sum += most;
  }
  return sum / kPlaces;
}

TEST_F(UltrasoundViewTest, ShowsTheNeedleOnlyInThePlane) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  const std::vector<Vec3> within = needle_in_plane(X_PT_, 0.0);
  ASSERT_TRUE(settle(view));
  const double without = brightness_along(look(view, "no_needle"), view, within);
  view.set_needle(within, 1.27);
  ASSERT_TRUE(settle(view));
  const double in_plane = brightness_along(look(view, "needle"), view, within);
  EXPECT_GT(in_plane, without + 25.0);
  view.set_needle(needle_in_plane(X_PT_, 15.0), 1.27);
  ASSERT_TRUE(settle(view));
  EXPECT_LT(brightness_along(look(view, "needle_beside"), view, within), without + 8.0);
}

/// Where the needle changes the picture, as a share of its width.
double column_of_change(const QImage& before, const QImage& after, const QRect& within) {
  double sum = 0.0, weighted = 0.0;
  for (int y = within.top(); y <= within.bottom(); ++y)
    for (int x = within.left(); x <= within.right(); ++x) {
      constexpr int kSpeckle = 60;
      const double change = std::max(0, qGray(after.pixel(x, y)) - qGray(before.pixel(x, y)) - kSpeckle);
      sum += change;
      weighted += change * (x - within.left());
    }
  return weighted / (sum * within.width());
}

TEST_F(UltrasoundViewTest, TransverseViewShowsThePatientsRightOnTheLeft) {
  UltrasoundView view;
  open(view, "aorta-transverse", {900, 700});
  ASSERT_LT(X_PT_.R().col(0).x(), -0.9);  // transverse, the marked side towards the patient's right
  ASSERT_TRUE(settle(view));
  const QImage before = look(view, "transverse");
  const std::vector<Vec3> shaft_P = needle_in_plane(X_PT_, 0.0);  // from the marked side
  ASSERT_LT(shaft_P[0].x(), shaft_P[1].x());
  view.set_needle(shaft_P, 1.27);
  ASSERT_TRUE(settle(view));
  const QImage after = look(view, "transverse_needle");
  EXPECT_LT(column_of_change(before, after, map_of(view).rect().toRect()), 0.45);
  EXPECT_LT(view.picture()->corners_P[0].x(), view.picture()->corners_P[1].x());

  SliceView slice(SliceKind::kAxial);
  slice.resize(400, 360);
  slice.show_patient(abdomen().patient);
  slice.set_focus(X_PT_.p());
  EXPECT_LT(slice.position_of(shaft_P[0]).x(), slice.position_of(shaft_P[1]).x());
}

TEST_F(UltrasoundViewTest, GuideShowsWhereTheNeedleGoes) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  const Vec3 pierce_T(10.0, 60.0, 0.0), along_T = Vec3(-0.3, 0.5, 0.8).normalized();
  const std::vector<Vec3> shaft = {X_PT_ * (pierce_T - 90.0 * along_T), X_PT_ * (pierce_T - 30.0 * along_T)};
  view.set_needle(shaft, 1.27);
  ASSERT_TRUE(settle(view));
  const QPointF at = map_of(view).to_view(ultrasound::shown_place_T(*view.picture(), X_PT_ * pierce_T));
  const auto is_marked = [&](const QImage& image) {
    const QColor c = image.pixelColor(at.toPoint());
    return c.green() > c.red() + 60;
  };
  EXPECT_FALSE(is_marked(look(view, "axis_hidden")));
  view.set_guide_visible(true);
  view.change_settings([](UltrasoundSettings& s) { s.guide.is_shown = true; });
  EXPECT_TRUE(is_marked(look(view, "axis")));
  view.set_guide_offered(false);
  EXPECT_FALSE(is_marked(look(view, "axis_not_offered")));
}

TEST_F(UltrasoundViewTest, CaliperMeasuresAKnownDistance) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  view.set_frozen(true);
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.is_frozen; }));
  const PictureMap map = map_of(view);
  const ultrasound::Vec2 a_T(-20.0, 40.0), b_T(25.0, 100.0);
  view.start_measuring(MeasuringTool::kDistance);
  for (const ultrasound::Vec2& mark_T : {a_T, b_T}) {
    mouse(view, QEvent::MouseMove, map.to_view(mark_T));
    press(view, map.to_view(mark_T));
    release(view, map.to_view(mark_T));
  }
  ASSERT_EQ(view.measurements().items().size(), 1U);
  EXPECT_EQ(view.measuring_tool(), MeasuringTool::kNone);
  // Marks are set to whole pixels.
  const double pixel_mm = 1.0 / map.pixels_per_mm();
  EXPECT_NEAR(std::get<ultrasound::DistanceCaliper>(view.measurements().items()[0]).distance_mm(), 75.0, pixel_mm);

  // The same by dragging; then an ellipse and an angle.
  view.start_measuring(MeasuringTool::kDistance);
  press(view, map.to_view(a_T));
  mouse(view, QEvent::MouseMove, map.to_view(b_T));
  release(view, map.to_view(b_T));
  ASSERT_EQ(view.measurements().items().size(), 2U);
  EXPECT_NEAR(std::get<ultrasound::DistanceCaliper>(view.measurements().items()[1]).distance_mm(), 75.0, pixel_mm);
  const auto click_all = [&](MeasuringTool tool, std::initializer_list<ultrasound::Vec2> marks_T) {
    view.start_measuring(tool);
    for (const ultrasound::Vec2& mark_T : marks_T) {
      press(view, map.to_view(mark_T));
      release(view, map.to_view(mark_T));
    }
  };
  click_all(MeasuringTool::kEllipse, {{-10.0, 60.0}, {10.0, 60.0}, {0.0, 68.0}});
  click_all(MeasuringTool::kAngle, {{0.0, 110.0}, {0.0, 80.0}, {30.0, 110.0}});
  ASSERT_EQ(view.measurements().items().size(), 4U);
  const auto& ellipse = std::get<ultrasound::EllipseCaliper>(view.measurements().items()[2]);
  EXPECT_NEAR(ellipse.area_mm2(), std::numbers::pi * 10.0 * 8.0, 8.0);
  EXPECT_NEAR(std::get<ultrasound::AngleCaliper>(view.measurements().items()[3]).angle_rad(), 0.5 * std::numbers::pi,
              0.02);
  const QImage image = look(view, "calipers");
  const QColor mark = image.pixelColor(map_of(view).to_view(b_T).toPoint());
  EXPECT_GT(mark.red(), mark.blue() + 60) << "the cross is drawn";

  strike(view, Qt::Key_Delete);
  EXPECT_EQ(view.measurements().items().size(), 3U);
  strike(view, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(view.measurements().items().size(), 4U);
  strike(view, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(view.measurements().items().size(), 3U);
  view.start_measuring(MeasuringTool::kAngle);
  press(view, map.to_view(a_T));
  strike(view, Qt::Key_Escape);
  EXPECT_EQ(view.measuring_tool(), MeasuringTool::kAngle) << "takes the mark back first";
  strike(view, Qt::Key_Escape);
  EXPECT_EQ(view.measuring_tool(), MeasuringTool::kNone);
}

TEST_F(UltrasoundViewTest, MovesCaliperEnds) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {900, 700});
  ASSERT_TRUE(settle(view));
  view.set_frozen(true);
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.is_frozen; }));
  const PictureMap map = map_of(view);
  const auto measure = [&](const ultrasound::Vec2& a_T, const ultrasound::Vec2& b_T) {
    view.start_measuring(MeasuringTool::kDistance);
    press(view, map.to_view(a_T));
    mouse(view, QEvent::MouseMove, map.to_view(b_T));
    release(view, map.to_view(b_T));
  };
  const auto distance = [&](std::size_t item) {
    return std::get<ultrasound::DistanceCaliper>(view.measurements().items()[item]).distance_mm();
  };
  measure({-20.0, 40.0}, {25.0, 100.0});
  measure({-30.0, 60.0}, {-30.0, 80.0});
  const double pixel_mm = 1.0 / map.pixels_per_mm();
  ASSERT_NEAR(distance(0), 75.0, pixel_mm);

  // Beside the mark nothing is picked up; over it the pointer says so.
  const QPointF end = map.to_view({25.0, 100.0});
  mouse(view, QEvent::MouseMove, end + QPointF(20.0, 0.0));
  EXPECT_EQ(view.cursor().shape(), Qt::ArrowCursor);
  EXPECT_FALSE(view.is_over_mark());
  mouse(view, QEvent::MouseMove, end + QPointF(5.0, 3.0));
  EXPECT_EQ(view.cursor().shape(), Qt::PointingHandCursor);
  EXPECT_TRUE(view.is_over_mark());

  press(view, end + QPointF(5.0, 3.0));
  EXPECT_NEAR(distance(0), 75.0, pixel_mm) << "a press alone moves nothing";
  for (const double share : {0.3, 0.7, 1.0})
    mouse(view, QEvent::MouseMove,
          end + QPointF(5.0, 3.0) + share * (map.to_view({-20.0, 70.0}) - map.to_view({25.0, 100.0})));
  look(view, "caliper_held");
  release(view, map.to_view({-20.0, 70.0}) + QPointF(5.0, 3.0));
  EXPECT_NEAR(distance(0), 30.0, 2.0 * pixel_mm);
  EXPECT_EQ(view.chosen_measurement(), 0U);
  const QPointF later = map.to_view({0.0, 90.0});
  mouse(view, QEvent::MouseMove, later);
  EXPECT_NEAR(distance(0), 30.0, 2.0 * pixel_mm) << "it was let go";
  strike(view, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_NEAR(distance(0), 75.0, pixel_mm) << "the whole drag is one step";
  strike(view, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_NEAR(distance(0), 30.0, 2.0 * pixel_mm);

  // Delete takes the one that was picked up, not the newest; without one, the newest.
  press(view, map.to_view({-20.0, 40.0}));
  release(view, map.to_view({-20.0, 40.0}));
  strike(view, Qt::Key_Delete);
  ASSERT_EQ(view.measurements().items().size(), 1U);
  EXPECT_NEAR(distance(0), 20.0, pixel_mm);
  press(view, map.to_view({-30.0, 80.0}));
  release(view, map.to_view({-30.0, 80.0}));
  press(view, later);
  release(view, later);
  EXPECT_FALSE(view.chosen_measurement());
}

TEST_F(UltrasoundViewTest, FrozenImageStaysAndStepsThroughTheCineLoop) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {480, 420});
  ASSERT_TRUE(settle(view));
  view.set_frozen(true);
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.is_frozen; }));
  view.set_transducer_pose(X_PT_ * Pose::translation({10.0, 0.0, 0.0}));
  for (int n = 0; n < 30; ++n) {
    view.advance(now_s_ += kFrame_s);
    QThread::msleep(4);
  }
  EXPECT_EQ(view.picture()->X_PT.p(), X_PT_.p());
  ASSERT_GE(view.cine().size, 2);
  const int newest = view.cine().position;
  look(view, "frozen");
  strike(view, Qt::Key_Left);
  ASSERT_TRUE(run_until(view, [&](const ultrasound::ScanPicture&) { return view.cine().position == newest - 1; }));
  view.set_frozen(false);
  EXPECT_TRUE(run_until(
      view, [&](const ultrasound::ScanPicture& p) { return (p.X_PT.p() - X_PT_.p()).norm() > 9.0 && !p.is_frozen; }));
}

TEST_F(UltrasoundViewTest, DopplerColoursTheVessel) {
  for (const char* name : {"portal-vein", "aorta"}) {
    UltrasoundView view;
    open(view, name, {900, 700});
    ASSERT_TRUE(settle(view));
    const auto within_scan = [&] {
      const PictureMap map = map_of(view);
      const ultrasound::ScanGeometry& scan = view.picture()->scan;
      const QPointF a = map.to_view(scan.to_cartesian({0.25 * scan.lines, 0.25 * scan.depth_mm}));
      const QPointF b = map.to_view(scan.to_cartesian({0.75 * scan.lines, 0.88 * scan.depth_mm}));
      return QRect(a.toPoint(), b.toPoint()).normalized();
    };
    EXPECT_LT(coloured(look(view, "no_colour"), within_scan()), 10) << name;
    view.change_settings([](UltrasoundSettings& s) { s.has_doppler = true; });
    int most = 0;
    for (int beat = 0; beat < 12 && most < 300; ++beat) {
      now_s_ += 0.09;
      ASSERT_TRUE(settle(view));
      most = std::max(most, coloured(look(view, name), within_scan()));
    }
    EXPECT_GE(most, 300) << name;
  }
}

TEST_F(UltrasoundViewTest, RollingUpdateEndsWithAFullFrame) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {480, 420});
  view.change_settings([](UltrasoundSettings& s) { s.is_rolling = true; });
  ASSERT_TRUE(settle(view));
  for (int step = 0; step < 12; ++step) {
    X_PT_ = X_PT_ * Pose::translation(Vec3(0.0, 0.0, 0.5));
    view.set_transducer_pose(X_PT_);
    const std::uint64_t before = view.picture()->number;
    ASSERT_TRUE(run_until(view, [&](const ultrasound::ScanPicture& p) { return p.number > before; }));
  }
  ASSERT_TRUE(settle(view));
  const std::vector<std::uint8_t> rolled = view.picture()->levels;
  view.change_settings([](UltrasoundSettings& s) { s.is_rolling = false; });
  ASSERT_TRUE(settle(view));
  const std::vector<std::uint8_t> whole = view.picture()->levels;
  ASSERT_EQ(rolled.size(), whole.size());
  // Only the receiver's noise differs.
  std::size_t different = 0;
  for (std::size_t n = 0; n < whole.size(); ++n) different += std::abs(rolled[n] - whole[n]) > 6 ? 1U : 0U;
  EXPECT_LT(different, whole.size() / 5);
}

TEST_F(UltrasoundViewTest, ColourBoxIsDraggedWithTheMouse) {
  UltrasoundView view;
  open(view, "aorta", {900, 700});
  view.change_settings([](UltrasoundSettings& s) { s.has_doppler = true; });
  ASSERT_TRUE(settle(view));
  const ultrasound::DopplerBox before = view.settings().doppler.box;
  const ultrasound::ScanGeometry scan = view.picture()->scan;
  const PictureMap map = map_of(view);
  const auto at = [&](double across, double along) {
    return map.to_view(scan.to_cartesian({across * (scan.lines - 1), along * scan.depth_mm}));
  };
  press(view, at(0.5, 0.5));
  mouse(view, QEvent::MouseMove, at(0.4, 0.45));
  release(view, at(0.4, 0.45));
  const ultrasound::DopplerBox moved = view.settings().doppler.box;
  EXPECT_NEAR(moved.first_line, before.first_line - 0.1, 0.01);
  EXPECT_NEAR(moved.far, before.far - 0.05, 0.01);
  EXPECT_NEAR(moved.last_line - moved.first_line, before.last_line - before.first_line, 1e-9);
  press(view, at(moved.last_line, 0.5));
  mouse(view, QEvent::MouseMove, at(moved.last_line - 0.2, 0.5));
  release(view, at(moved.last_line - 0.2, 0.5));
  EXPECT_NEAR(view.settings().doppler.box.last_line, moved.last_line - 0.2, 0.01);
  EXPECT_EQ(view.settings().doppler.box.first_line, moved.first_line);
}

TEST_F(UltrasoundViewTest, WarnsWhenTheFaceHasNoSkinContact) {
  UltrasoundView view;
  open(view, "liver-right-kidney", {480, 420});
  view.set_transducer_pose(X_PT_ * Pose::translation({0.0, -40.0, 0.0}));
  ASSERT_TRUE(settle(view));
  EXPECT_LT(view.picture()->coupled_share, 0.02);
  const QImage image = look(view, "no_contact");
  int warning = 0;
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 120; ++x) {
      const QColor c = image.pixelColor(x, y);
      warning += c.red() > 180 && c.blue() < 110 ? 1 : 0;
    }
  EXPECT_GT(warning, 20);
}

TEST_F(UltrasoundViewTest, OverlaysDoNotCoverTheScan) {
  // Of every transducer in small and large views: caption, bars and scale are beside it.
  for (const ultrasound::Transducer& probe : abdomen().transducers)
    for (const QSize size : {QSize(240, 180), QSize(480, 420), QSize(900, 700), QSize(700, 300), QSize(300, 800)}) {
      const ultrasound::ScanGeometry scan = ultrasound::make_scan_geometry(probe, probe.depth_mm, 128, 256);
      const bool is_small = size.width() < 300;
      const MarginSpace room{is_small ? QSizeF(75.0, 32.0) : QSizeF(110.0, 130.0),
                             is_small ? QSizeF() : QSizeF(56.0, 150.0), 34.0, 8.0};
      const UltrasoundLayout layout = lay_out(size, scan, room);
      const ultrasound::RasterGeometry raster = ultrasound::fit_raster(scan, static_cast<int>(layout.picture.width()),
                                                                       static_cast<int>(layout.picture.height()));
      const PictureMap map(layout.picture, raster);
      for (double line = 0.0; line < scan.lines; line += 1.0)
        for (double depth_mm = 0.0; depth_mm <= scan.depth_mm; depth_mm += scan.depth_mm / 100.0) {
          const QPointF at = map.to_view(scan.to_cartesian({line, depth_mm}));
          ASSERT_FALSE(layout.caption.contains(at)) << probe.name << " " << size.width();
          ASSERT_FALSE(layout.bars.contains(at)) << probe.name << " " << size.width();
          ASSERT_LT(at.x(), layout.scale_x) << probe.name << " " << size.width();
          ASSERT_GE(at.x(), 0.0);
        }
    }
}

TEST_F(UltrasoundViewTest, OrientationMarkerIsFullyVisible) {
  for (const char* probe : {"L14-5", "P4-2", "C5-2"})
    for (const QSize size : {QSize(480, 420), QSize(240, 180), QSize(300, 800)})
      for (const bool is_mirrored : {true, false}) {
        UltrasoundView view;
        open(view, "aorta", size, probe);
        view.change_settings([&](UltrasoundSettings& s) { s.display.is_mirrored = is_mirrored; });
        ASSERT_TRUE(
            run_until(view, [&](const ultrasound::ScanPicture& p) { return p.display == view.settings().display; }));
        look(view, qPrintable(QStringLiteral("marker_%1_%2").arg(probe).arg(size.width())));
        const PictureMap map = map_of(view);
        const ultrasound::ScanPicture& picture = *view.picture();
        const QPointF marker = marker_place(map, ultrasound::make_scan_annotation(picture.raster, picture.scan, {}));
        EXPECT_GE(marker.x(), kMarker_px) << probe << " " << size.width() << is_mirrored;
        EXPECT_GE(marker.y(), kMarker_px) << probe << " " << size.width() << is_mirrored;
        EXPECT_LE(marker.x(), size.width() - kMarker_px) << probe << " " << size.width() << is_mirrored;
        EXPECT_EQ(marker.x() < map.rect().center().x(), is_mirrored) << probe << " " << size.width();
      }
}

TEST_F(UltrasoundViewTest, ControlsAreKeptForEachTransducer) {
  {
    UltrasoundView view;
    open(view, "liver-right-kidney", {480, 420});
    view.change_settings([](UltrasoundSettings& s) {
      s.display.gain_db = 7.0;
      s.display.tgc_db[3] = -5.0;
      s.acquisition.depth_mm = 110.0;
      s.is_rolling = true;
      s.display.gray_map = ultrasound::GrayMap::kLinear;
    });
    view.choose_transducer(transducer("L14-5"));
    EXPECT_EQ(view.settings().display.gain_db, 0.0);
    view.change_settings([](UltrasoundSettings& s) { s.display.gain_db = -3.0; });
  }
  UltrasoundView view;
  view.show_patient(abdomen().scene, nullptr, transducer("C5-2"));
  EXPECT_EQ(view.settings().display.gain_db, 7.0);
  EXPECT_EQ(view.settings().display.tgc_db[3], -5.0);
  EXPECT_EQ(view.settings().acquisition.depth_mm, 110.0);
  EXPECT_TRUE(view.settings().is_rolling);
  EXPECT_EQ(view.settings().display.gray_map, ultrasound::GrayMap::kLinear);
  view.reset_settings();
  EXPECT_EQ(view.settings(), default_settings(transducer("C5-2")));
}

TEST_F(UltrasoundViewTest, LinearArrayFillsItsView) {
  UltrasoundView view;
  open(view, "aorta", {480, 420}, "L14-5");
  view.change_settings([](UltrasoundSettings& s) { s.acquisition.depth_mm = 50.0; });
  ASSERT_TRUE(settle(view));
  look(view, "linear");
  EXPECT_GT(map_of(view).pixels_per_mm() * 50.0, 300.0);
}

}  // namespace
}  // namespace trocar::trainer
