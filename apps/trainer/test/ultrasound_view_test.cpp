#include "views/ultrasound_view.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSettings>
#include <QTemporaryDir>
#include <QThread>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/data_dir.h"
#include "io/patient_source.h"
#include "ultrasound/probe_placement.h"

namespace trocar::trainer {
namespace {

constexpr double kFrame_s = 1.0 / 60.0;

struct Patient {
  VirtualPatient patient;
  std::shared_ptr<const AcousticScene> scene;
  std::shared_ptr<const VesselFlow> flow;
  std::vector<Transducer> transducers;
};

const Patient& abdomen() {
  static const Patient made = [] {
    Patient p;
    const auto data = data_dir();
    p.patient = open_patient({"abdomen", 1}).value();
    p.scene = make_acoustic_scene(p.patient, load_acoustic_table(data / "acoustics.toml").value()).value();
    p.flow = make_vessel_flow(p.patient, load_flow_table(data / "flow.toml").value()).value();
    p.transducers = load_transducers(data / "transducers.toml").value();
    return p;
  }();
  return made;
}

const Transducer& transducer(const std::string& name) {
  for (const Transducer& t : abdomen().transducers)
    if (t.name == name) return t;
  ADD_FAILURE() << name;
  return abdomen().transducers.front();
}

/// A standard view's place, and its depth.
struct Place {
  Pose X_PT;
  double depth_mm;
};
Place place(const char* view, const Transducer& probe) {
  const auto views = load_probe_views(data_dir() / "views.toml").value();
  const ProbeView found = choose_view(abdomen().patient, views, view).value();
  return {place_probe(abdomen().patient, found, probe).value(), found.depth_mm};
}

class UltrasoundViewTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { abdomen(); }

  void SetUp() override {
    QCoreApplication::setOrganizationName(QStringLiteral("Trocar test"));
    QCoreApplication::setApplicationName(QStringLiteral("ultrasound view"));
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder_.path());
  }

  void open(UltrasoundView& view, const char* view_name, QSize size, const char* probe_name = "C5-2") {
    const Transducer& probe = transducer(probe_name);
    view.resize(size);
    view.show();
    view.show_patient(abdomen().scene, abdomen().flow, probe);
    const Place at = place(view_name, probe);
    view.change_settings([&](UltrasoundSettings& s) { s.acquisition.depth_mm = at.depth_mm; });
    X_PT_ = at.X_PT;
    view.set_transducer_pose(X_PT_);
  }

  /// As the frame loop does, until it is as it should be; false after a long time.
  template <class Ready>
  bool run_until(UltrasoundView& view, const Ready& is_ready) {
    QElapsedTimer timer;
    for (timer.start(); timer.elapsed() < 60000;) {
      now_s_ += kFrame_s;
      view.advance(now_s_);
      QCoreApplication::processEvents();
      if (view.picture() && is_ready(*view.picture())) return true;
      QThread::msleep(4);
    }
    return false;
  }

  /// A picture of now at full detail.
  bool settle(UltrasoundView& view) {
    const std::uint64_t before = view.picture() ? view.picture()->number : 0;
    const Acquisition& a = view.settings().acquisition;
    return run_until(view, [&](const ScanPicture& p) {
      return p.detail == ScanDetail::kFull && p.number > before + 1 && p.acquisition.depth_mm == a.depth_mm &&
             p.display == view.settings().display && (!p.colour.pixels.empty()) == view.settings().has_doppler;
    });
  }

  /// The widget as it is shown; kept where TROCAR_TEST_PICTURES says.
  QImage look(UltrasoundView& view, const char* name) {
    view.advance(now_s_ += kFrame_s);
    const QImage image = view.grab().toImage();
    if (const char* folder = std::getenv("TROCAR_TEST_PICTURES"))
      image.save(QStringLiteral("%1/usview_%2.png").arg(QString::fromUtf8(folder), QString::fromUtf8(name)));
    return image;
  }

  static void press(UltrasoundView& view, const QPointF& at) { mouse(view, QEvent::MouseButtonPress, at); }
  static void release(UltrasoundView& view, const QPointF& at) { mouse(view, QEvent::MouseButtonRelease, at); }
  static void mouse(UltrasoundView& view, QEvent::Type type, const QPointF& at) {
    const bool is_move = type == QEvent::MouseMove;
    QMouseEvent event(type, at, view.mapToGlobal(at.toPoint()), is_move ? Qt::NoButton : Qt::LeftButton,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&view, &event);
  }
  static void strike(UltrasoundView& view, int key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QKeyEvent down(QEvent::KeyPress, key, modifiers);
    QCoreApplication::sendEvent(&view, &down);
  }

  QTemporaryDir folder_;
  Pose X_PT_;
  double now_s_ = 0.0;
};

PictureMap map_of(const UltrasoundView& view) {
  const ScanPicture& p = *view.picture();
  return view.picture_map().value_or(PictureMap(QRectF(0, 0, 1, 1), p.raster));
}

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

TEST_F(UltrasoundViewTest, FanIsBrightInTissueAndBlackBeside) {
  for (const QSize size : {QSize(480, 420), QSize(900, 700), QSize(240, 180)}) {
    UltrasoundView view;
    open(view, "liver-right-kidney", size);
    ASSERT_TRUE(settle(view));
    const QImage image = look(view, qPrintable(QStringLiteral("liver_%1").arg(size.width())));
    const PictureMap map = map_of(view);
    const ScanGeometry& scan = view.picture()->scan;
    const double middle = scan.middle_line();
    EXPECT_GT(mean_gray(image, map.to_view(scan.to_cartesian({middle, 50.0})), 12), 25.0);
    for (const double line : {-6.0, scan.lines + 5.0})
      for (const double share : {0.35, 0.6, 0.9})
        EXPECT_EQ(mean_gray(image, map.to_view(scan.to_cartesian({line, share * scan.depth_mm})), 0), 0.0)
            << line << " " << share;
    // The picture uses the room that it has.
    EXPECT_GT(map.pixels_per_mm() * scan.depth_mm, 0.7 * size.height());
  }
}

}  // namespace
}  // namespace trocar::trainer
