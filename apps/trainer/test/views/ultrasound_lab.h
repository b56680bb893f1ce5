#pragma once

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSettings>
#include <QTemporaryDir>
#include <QThread>
#include <cstdlib>

#include "core/files/folders.h"
#include "test/open_abdomen.h"
#include "ultrasound/probe/probe_placement.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {

inline constexpr double kFrame_s = 1.0 / 60.0;

struct Patient {
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  std::shared_ptr<ultrasound::FlowOnDemand> flow;
  std::vector<ultrasound::Transducer> transducers;
};

inline const Patient& abdomen() {
  static const Patient made = [] {
    Patient p;
    const cases::OpenCase& open = *open_abdomen();
    p.patient = open.the_case.patient;
    open.later->wait();
    p.scene = open.later->acoustic();
    p.flow = open.flow;
    p.transducers = ultrasound::load_transducers(data_dir() / "transducers.toml").value();
    return p;
  }();
  return made;
}

inline const ultrasound::Transducer& transducer(const std::string& name) {
  for (const ultrasound::Transducer& t : abdomen().transducers)
    if (t.name == name) return t;
  ADD_FAILURE() << name;
  return abdomen().transducers.front();
}

/// Pose and depth of a standard view; "portal-vein" shows that vein through the liver.
struct Place {
  Pose X_PT;
  double depth_mm;
};
inline Place place(const std::string& name, const ultrasound::Transducer& probe) {
  const auto views = ultrasound::load_probe_views(data_dir() / "views.toml").value();
  const bool is_portal = name == "portal-vein";
  ultrasound::ProbeView view =
      ultrasound::choose_view(*abdomen().patient, views, is_portal ? "liver-lesion" : name).value();
  if (is_portal) view.targets = {"portal_vein*"};
  return {ultrasound::place_probe(*abdomen().patient, view, probe).value().X_PT, view.depth_mm};
}

/// Views of the embedded patient, with a frame loop, a mouse and keys; the settings are stored in a temporary folder.
class UltrasoundViewTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { abdomen(); }

  void SetUp() override {
    QCoreApplication::setOrganizationName(QStringLiteral("Trocar test"));
    QCoreApplication::setApplicationName(QStringLiteral("ultrasound-view"));
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder_.path());
  }

  void open(UltrasoundView& view, const char* view_name, QSize size, const char* probe_name = "C5-2") {
    const ultrasound::Transducer& probe = transducer(probe_name);
    view.resize(size);
    view.show();
    view.show_patient(abdomen().scene, abdomen().flow, probe);
    const Place at = place(view_name, probe);
    view.change_settings([&](UltrasoundSettings& s) { s.acquisition.depth_mm = at.depth_mm; });
    X_PT_ = at.X_PT;
    view.set_transducer_pose(X_PT_);
  }

  /// Runs the frame loop until `is_ready` returns true; false after a timeout of 60 s.
  template <class Ready>
  bool run_until(UltrasoundView& view, const Ready& is_ready) {
    QElapsedTimer timer;
    for (timer.start(); timer.elapsed() < 300'000;) {
      now_s_ += kFrame_s;
      view.advance(now_s_);
      QCoreApplication::processEvents();
      if (view.picture() && is_ready(*view.picture())) return true;
      QThread::msleep(4);
    }
    return false;
  }

  /// Waits for a new image at full detail.
  bool settle(UltrasoundView& view) {
    const std::uint64_t before = view.picture() ? view.picture()->number : 0;
    const ultrasound::Acquisition& a = view.settings().acquisition;
    return run_until(view, [&](const ultrasound::ScanPicture& p) {
      return p.detail == ultrasound::ScanDetail::kFull && p.number > before + 1 &&
             p.acquisition.depth_mm == a.depth_mm && p.display == view.settings().display &&
             (!p.colour.pixels.empty()) == view.settings().has_doppler;
    });
  }

  /// Image of the displayed widget; saved in the folder TROCAR_TEST_PICTURES.
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

inline PictureMap map_of(const UltrasoundView& view) {
  const ultrasound::ScanPicture& p = *view.picture();
  return view.picture_map().value_or(PictureMap(QRectF(0, 0, 1, 1), p.raster));
}

}  // namespace trocar::trainer
