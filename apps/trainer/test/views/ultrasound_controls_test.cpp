#include "views/ultrasound/ultrasound_controls.h"

#include <QCheckBox>
#include <QComboBox>
#include <QPushButton>
#include <QSlider>

#include "test/views/ultrasound_lab.h"

namespace trocar::trainer {
namespace {

class UltrasoundControlsTest : public UltrasoundViewTest {};

template <class Widget>
Widget& control(UltrasoundControls& controls, const char* name) {
  auto* found = controls.findChild<Widget*>(QString::fromLatin1(name));
  if (found == nullptr) ADD_FAILURE() << name;
  return *found;
}

TEST_F(UltrasoundControlsTest, ControlsAndViewShowTheSame) {
  UltrasoundView view;
  open(view, "aorta", {480, 420});
  UltrasoundControls controls(view);
  controls.resize(300, 1010);
  controls.show();
  ASSERT_TRUE(settle(view));
  control<QSlider>(controls, "ultrasound-gain").setValue(9);
  EXPECT_EQ(view.settings().display.gain_db, 9.0);
  control<QSlider>(controls, "ultrasound-tgc-8").setValue(-4);
  EXPECT_EQ(view.settings().display.tgc_db[7], -4.0);
  view.change_settings([](UltrasoundSettings& s) { s.acquisition.depth_mm = 120.0; });
  EXPECT_EQ(control<QSlider>(controls, "ultrasound-depth").value(), 24);
  control<QCheckBox>(controls, "ultrasound-rolling").click();
  EXPECT_TRUE(view.settings().is_rolling);
  auto& harmonic = control<QCheckBox>(controls, "ultrasound-harmonic");
  harmonic.click();
  EXPECT_TRUE(view.settings().acquisition.is_harmonic);
  EXPECT_EQ(view.settings().acquisition.frequency_mhz, 4.0) << "received: twice the lowest transmitted one";
  view.set_harmonic(false);
  EXPECT_FALSE(harmonic.isChecked());
  EXPECT_EQ(view.settings().acquisition.frequency_mhz, view.transducer().frequency_mhz);
  control<QCheckBox>(controls, "ultrasound-doppler").click();
  EXPECT_TRUE(view.settings().has_doppler);
  control<QPushButton>(controls, "ultrasound-distance").click();
  EXPECT_EQ(view.measuring_tool(), MeasuringTool::kDistance);
  control<QPushButton>(controls, "ultrasound-freeze").click();
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.is_frozen; }));
  EXPECT_TRUE(control<QSlider>(controls, "ultrasound-cine").isVisible());
  if (const char* folder = std::getenv("TROCAR_TEST_PICTURES")) {
    controls.setStyleSheet(QStringLiteral("trocar--trainer--UltrasoundControls { background: #181e27; }"));
    controls.grab().save(QStringLiteral("%1/usview_controls.png").arg(QString::fromUtf8(folder)));
  }
  control<QSlider>(controls, "ultrasound-cine").setValue(0);
  EXPECT_TRUE(run_until(view, [&](const ultrasound::ScanPicture&) { return view.cine().position == 0; }));
  control<QPushButton>(controls, "ultrasound-freeze").click();
  EXPECT_FALSE(view.is_frozen());
  auto& presets = control<QComboBox>(controls, "ultrasound-preset");
  presets.setCurrentIndex(presets.findText(QStringLiteral("Shallow vessel")));
  Q_EMIT presets.activated(presets.currentIndex());
  EXPECT_EQ(view.transducer().name, "L14-5");
  EXPECT_EQ(view.settings().acquisition.depth_mm, 40.0);
  EXPECT_EQ(control<QComboBox>(controls, "ultrasound-transducer").currentText(), QStringLiteral("L14-5"));
  // A preset's name does not stay beside another transducer.
  auto& transducers = control<QComboBox>(controls, "ultrasound-transducer");
  transducers.setCurrentIndex(transducers.findText(QStringLiteral("C5-2")));
  Q_EMIT transducers.activated(transducers.currentIndex());
  EXPECT_EQ(view.transducer().name, "C5-2");
  EXPECT_EQ(presets.currentIndex(), 0) << presets.currentText().toStdString();
  transducers.setCurrentIndex(transducers.findText(QStringLiteral("L14-5")));
  Q_EMIT transducers.activated(transducers.currentIndex());
  control<QPushButton>(controls, "ultrasound-reset").click();
  EXPECT_EQ(view.settings(), default_settings(transducer("L14-5")));
}

/// An even panorama around the face of a pose.
std::shared_ptr<ultrasound::PanoramaOnDemand> panorama_at(const Pose& X_PT) {
  return std::make_shared<ultrasound::PanoramaOnDemand>([X_PT] {
    volume::GridGeometry geometry;
    geometry.size = {120, 120, 40};
    geometry.spacing_mm = Vec3::Constant(2.0);
    geometry.origin_P = Vec3(-120.0, -40.0, -40.0);
    return ultrasound::make_panorama(volume::LabelGrid(geometry, 90), X_PT);
  });
}

TEST_F(UltrasoundControlsTest, OffersTheEngineOnlyWithAPanorama) {
  UltrasoundView view;
  open(view, "aorta", {320, 280});
  UltrasoundControls controls(view);
  auto& engine = control<QComboBox>(controls, "ultrasound-engine");
  EXPECT_FALSE(engine.isEnabled());
  EXPECT_EQ(engine.currentIndex(), 0);
  view.show_patient(abdomen().scene, abdomen().flow, transducer("C5-2"), panorama_at(X_PT_));
  ASSERT_TRUE(engine.isEnabled());
  EXPECT_EQ(engine.currentIndex(), 0) << "a case begins with its own engine";
  engine.setCurrentIndex(1);
  Q_EMIT engine.activated(1);
  EXPECT_TRUE(view.settings().is_panorama);
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.panorama_share > 0.5; }));
  view.reset_settings();
  view.choose_transducer(transducer("P4-2"));
  EXPECT_EQ(engine.currentIndex(), 1) << "the engine belongs to the case, not to the transducer";
  engine.setCurrentIndex(0);
  Q_EMIT engine.activated(0);
  EXPECT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.panorama_share == 0.0; }));
}

}  // namespace
}  // namespace trocar::trainer
