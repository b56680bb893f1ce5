#include "panels/structure_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QSlider>
#include <QToolButton>
#include <algorithm>

#include "script/widget_events.h"
#include "test/widget_actions.h"
#include "views/patient/patient_view.h"

namespace trocar::trainer {
namespace {

/// A ball of 200 points is too round for a test of buttons: a tetrahedron is enough.
TriangleMesh tetrahedron(const Vec3f& middle_P, float size_mm) {
  TriangleMesh mesh;
  mesh.vertices = {middle_P + size_mm * Vec3f(1, 1, 1), middle_P + size_mm * Vec3f(-1, -1, 1),
                   middle_P + size_mm * Vec3f(-1, 1, -1), middle_P + size_mm * Vec3f(1, -1, -1)};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return mesh;
}

class StructurePanelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    anatomy::VirtualPatient patient;
    patient.label_table.labels = {{1, "kidney_left", "kidney", {200, 40, 40}}, {2, "rib_left_9", "bone", {0, 0, 0}}};
    std::vector<anatomy::NamedMesh> meshes = {{"skin", tetrahedron({0, 0, 0}, 100)},
                                              {"kidney_left", tetrahedron({30, 0, 0}, 10)},
                                              {"rib_left_9", tetrahedron({0, 0, 40}, 10)}};
    view.show_patient(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)),
                      std::make_shared<const std::vector<anatomy::NamedMesh>>(std::move(meshes)));
    panel = std::make_unique<StructurePanel>(view);
    panel->resize(300, 600);
    panel->show();
    QApplication::processEvents();
  }
  template <class Widget>
  Widget& find(const char* name) {
    auto* widget = panel->findChild<Widget*>(QString::fromLatin1(name));
    EXPECT_NE(widget, nullptr) << name;
    return *widget;
  }
  double opacity(const char* name) {
    for (const scene::StructureInfo& info : view.structures()) {
      if (info.name == name) return info.opacity;
    }
    return -1.0;
  }
  PatientView view;
  std::unique_ptr<StructurePanel> panel;
};

TEST_F(StructurePanelTest, SliderAndEyeSetTheOpacity) {
  find<QSlider>("structure-opacity-kidney-left").setValue(40);
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.4);
  find<QToolButton>("structure-eye-kidney-left").click();
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.0);
  EXPECT_EQ(find<QSlider>("structure-opacity-kidney-left").value(), 0);
  find<QToolButton>("structure-eye-kidney-left").click();
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 1.0);
}

TEST_F(StructurePanelTest, PresetsMoveTheSliders) {
  find<QToolButton>("preset-bones").click();
  EXPECT_DOUBLE_EQ(opacity("skin"), 0.0);
  EXPECT_EQ(find<QSlider>("structure-opacity-skin").value(), 0);
  EXPECT_EQ(find<QSlider>("structure-opacity-rib-left-9").value(), 100);
  find<QToolButton>("preset-all").click();
  EXPECT_GT(opacity("skin"), 0.0);
}

TEST_F(StructurePanelTest, UndoesAndRedoesOpacities) {
  auto& undo = find<QToolButton>("structure-undo");
  auto& redo = find<QToolButton>("structure-redo");
  EXPECT_FALSE(undo.isEnabled());
  const double skin = opacity("skin"), kidney = opacity("kidney_left");
  auto& slider = find<QSlider>("structure-opacity-kidney-left");
  slider.setSliderDown(true);
  for (const int percent : {80, 60, 35}) slider.setValue(percent);
  slider.setSliderDown(false);
  slider.setValue(30);  // a key: a step of its own
  find<QToolButton>("preset-bones").click();
  find<QToolButton>("structure-eye-skin").click();
  const double shown = opacity("skin");
  EXPECT_GT(shown, 0.0);

  undo.click();
  EXPECT_DOUBLE_EQ(opacity("skin"), 0.0);
  undo.click();
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.3);
  EXPECT_DOUBLE_EQ(opacity("skin"), skin);
  EXPECT_EQ(slider.value(), 30);
  undo.click();
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.35);
  undo.click();
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), kidney);
  EXPECT_FALSE(undo.isEnabled());
  for (int n = 0; n < 4; ++n) redo.click();
  EXPECT_DOUBLE_EQ(opacity("skin"), shown);
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.0);
  EXPECT_FALSE(redo.isEnabled());
}

TEST_F(StructurePanelTest, UndoKeysWorkInThePanel) {
  find<QSlider>("structure-opacity-kidney-left").setValue(40);
  panel->activateWindow();
  find<QSlider>("structure-opacity-kidney-left").setFocus();
  QApplication::processEvents();
  EXPECT_TRUE(press_keys(*panel, QStringLiteral("Ctrl+Z")));
  EXPECT_NE(opacity("kidney_left"), 0.4);
  EXPECT_TRUE(press_keys(*panel, QStringLiteral("Ctrl+Shift+Z")));
  EXPECT_DOUBLE_EQ(opacity("kidney_left"), 0.4);
}

TEST_F(StructurePanelTest, ClearsUndoForAnotherPatient) {
  find<QSlider>("structure-opacity-kidney-left").setValue(40);
  panel->rebuild();
  EXPECT_FALSE(find<QToolButton>("structure-undo").isEnabled());
}

TEST_F(StructurePanelTest, TogglesReachTheView) {
  find<QToolButton>("plane-tip").click();
  EXPECT_TRUE(view.mpr().has_tip_plane);
  find<QToolButton>("show-landmarks").click();
  EXPECT_TRUE(view.are_landmarks_visible());
  find<QToolButton>("show-guidance").click();
  EXPECT_FALSE(view.is_guidance_visible());
  view.set_guidance(scene::Guidance::kNone);
  panel->refresh();
  EXPECT_FALSE(find<QToolButton>("show-guidance").isEnabled());
  find<QComboBox>("volume-preset").setCurrentIndex(1);
  EXPECT_EQ(view.volume_preset(), scene::VolumePreset::kBone);
}

TEST_F(StructurePanelTest, EveryControlHasANameATooltipAndFits) {
  save(*panel, "structures.png");
  for (QWidget* widget : panel->findChildren<QWidget*>()) {
    if (qobject_cast<QToolButton*>(widget) == nullptr && qobject_cast<QSlider*>(widget) == nullptr) continue;
    if (!widget->isVisible()) continue;
    EXPECT_FALSE(widget->objectName().isEmpty());
    EXPECT_FALSE(widget->toolTip().isEmpty()) << widget->objectName().toStdString();
    EXPECT_FALSE(widget->accessibleName().isEmpty()) << widget->objectName().toStdString();
    const QRect place(widget->mapTo(panel.get(), QPoint(0, 0)), widget->size());
    if (qobject_cast<QToolButton*>(widget) != nullptr) {
      EXPECT_GE(widget->width(), widget->sizeHint().width()) << widget->objectName().toStdString() << " is cut off";
    }
    EXPECT_LE(place.right(), panel->width()) << widget->objectName().toStdString();
  }
}

}  // namespace
}  // namespace trocar::trainer
