#include "parameters/parameter_panel.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSlider>
#include <QToolButton>
#include <algorithm>

#include "parameters/force_preview.h"
#include "parameters/parameter_scale.h"
#include "script/cut_off.h"
#include "script/widget_events.h"
#include "test/parameter_lab.h"

namespace trocar::trainer {
namespace {

using ParameterPanelTest = ParameterLab;

TEST_F(ParameterPanelTest, FitsEveryText) {
  for (const int width : {320, 340, 420}) {
    panel.resize(width, 900);
    settle();
    EXPECT_TRUE(find_cut_off(panel).isEmpty()) << width << ": " << find_cut_off(panel).join(';').toStdString();
  }
}

TEST_F(ParameterPanelTest, ListsTissuesOnThePathFirst) {
  std::vector<std::string> on_path;
  for (const cases::PathPiece& piece : opened->pieces)
    if (std::find(on_path.begin(), on_path.end(), piece.tissue) == on_path.end()) on_path.push_back(piece.tissue);
  std::vector<std::pair<int, std::string>> shown;
  for (auto* header : panel.findChildren<QPushButton*>())
    if (header->objectName().startsWith(QStringLiteral("parameter-tissue-")))
      shown.emplace_back(header->mapTo(&panel, QPoint()).y(), header->objectName().mid(17).toStdString());
  std::sort(shown.begin(), shown.end());
  ASSERT_EQ(shown.size(), opened->the_case.tissues.tissues.size()) << "all but air, and the transfer functions";
  for (std::size_t n = 0; n < on_path.size(); ++n) EXPECT_EQ(shown[n].second, on_path[n]);
  EXPECT_TRUE(sent.empty()) << "nothing differs";
}

TEST_F(ParameterPanelTest, StifferCapsuleChangesThePredictionUntilUndo) {
  open_tissue("parameter-tissue-liver");
  const double before_mm = way_mm("liver_capsule");
  const std::vector<cases::CurvePoint> before = panel.preview().changed_curve();
  ASSERT_GT(before_mm, 0.0);
  type("parameter-liver-k", "0.05");
  EXPECT_TRUE(sent.empty()) << "waits for more";
  settle();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.k=0.05")});
  const auto expected = cases::predict_force(opened->the_case, {"liver.k=0.05"}, "insertion");
  ASSERT_TRUE(expected);
  const auto& curve = panel.preview().changed_curve();
  ASSERT_EQ(curve.size(), expected->size());
  for (std::size_t n = 0; n < curve.size(); ++n) ASSERT_EQ(curve[n].force_n, (*expected)[n].force_n);
  EXPECT_GT(way_mm("liver_capsule"), before_mm + 0.2) << "a softer capsule gives way later";
  keep_picture("parameters_changed.png");

  EXPECT_TRUE(press_keys(panel, QStringLiteral("Ctrl+Z")));
  EXPECT_EQ(part<QLineEdit>("parameter-liver-k")->text(), QStringLiteral("0.42"));
  settle();
  EXPECT_EQ(sent.back(), QStringList());
  EXPECT_EQ(panel.preview().changed_curve().size(), before.size());
  EXPECT_EQ(way_mm("liver_capsule"), before_mm);
  EXPECT_TRUE(press_keys(panel, QStringLiteral("Ctrl+Shift+Z")));
  settle();
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.k=0.05")});
}

TEST_F(ParameterPanelTest, SliderDragIsOneUndoStepAndOneMessage) {
  open_tissue("parameter-tissue-liver");
  auto* slider = part<QSlider>("parameter-liver-fc-slider");
  slider->setSliderDown(true);
  for (int position = 100; position <= 200; position += 20) slider->setValue(position);
  slider->setSliderDown(false);
  settle();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.fc=2")});
  part<QToolButton>("parameter-undo")->click();
  EXPECT_TRUE(panel.settings().isEmpty());
}

TEST_F(ParameterPanelTest, RefusesOutOfRangeValuesAndShowsTheRange) {
  open_tissue("parameter-tissue-liver");
  auto* refused = part<QLabel>("parameter-liver-k-refused");
  for (const char* bad : {"51", "0", "-1", "nan", "1e999", "much", "never"}) {
    type("parameter-liver-k", bad);
    EXPECT_TRUE(refused->isVisible()) << bad;
    EXPECT_TRUE(refused->text().contains(QStringLiteral("0.001 to 50 N/mm"))) << bad;
    EXPECT_TRUE(panel.settings().isEmpty()) << bad;
  }
  keep_picture("parameters_refused.png");
  key(*part<QLineEdit>("parameter-liver-k"), Qt::Key_Escape);
  EXPECT_EQ(part<QLineEdit>("parameter-liver-k")->text(), QStringLiteral("0.42"));
  EXPECT_FALSE(refused->isVisible());
  type("parameter-liver-fp", "never");
  EXPECT_EQ(panel.settings(), QStringList{QStringLiteral("liver.fp=never")});
  type("parameter-liver-fp", "2,5");
  EXPECT_EQ(panel.settings(), QStringList{QStringLiteral("liver.fp=2.5")});
}

TEST_F(ParameterPanelTest, ThresholdsThatWouldCrossAreRefused) {
  open_tissue("parameter-tissue-transfer");
  type("parameter-transfer-none", "60");
  EXPECT_TRUE(part<QLabel>("parameter-transfer-none-refused")->isVisible());
  EXPECT_TRUE(panel.settings().isEmpty());
  type("parameter-transfer-full", "100");
  type("parameter-transfer-none", "60");
  type("parameter-transfer-tn", "1.5");
  const QStringList expected{QStringLiteral("transfer.tn_factor=1.5"), QStringLiteral("transfer.full=100"),
                             QStringLiteral("transfer.none=60")};
  EXPECT_EQ(panel.settings(), expected);
  anatomy::TissueTable table = opened->the_case.tissues;
  for (const QString& setting : panel.settings()) EXPECT_TRUE(anatomy::apply_override(table, setting.toStdString()));
  keep_picture("parameters_transfer.png");
}

TEST_F(ParameterPanelTest, ResetsANumberATissueAndAll) {
  open_tissue("parameter-tissue-liver");
  type("parameter-liver-k", "0.5");
  type("parameter-liver-mu", "0.3");
  open_tissue("parameter-tissue-skin");
  type("parameter-skin-nu", "0.05");
  EXPECT_EQ(panel.settings().size(), 3);
  part<QToolButton>("parameter-skin-nu-reset")->click();
  EXPECT_EQ(panel.settings(), (QStringList{QStringLiteral("liver.k=0.5"), QStringLiteral("liver.mu=0.3")}));
  open_tissue("parameter-tissue-liver");
  part<QPushButton>("parameter-liver-reset-all")->click();
  EXPECT_TRUE(panel.settings().isEmpty());
  part<QToolButton>("parameter-undo")->click();
  EXPECT_EQ(panel.settings().size(), 2);
  part<QToolButton>("parameter-reset-all")->click();
  EXPECT_TRUE(panel.settings().isEmpty());
}

TEST_F(ParameterPanelTest, EmitsAndPreviewsAnotherForceModel) {
  auto* choice = part<QComboBox>("parameter-model");
  EXPECT_EQ(choice->currentData().toString(), QStringLiteral("insertion"));
  const double insertion_n = panel.preview().changed_curve().back().force_n;
  key(*choice, Qt::Key_Down);
  ASSERT_EQ(models, std::vector<QString>{QStringLiteral("proxy")});
  settle();
  ASSERT_FALSE(panel.preview().changed_curve().empty());
  EXPECT_NE(panel.preview().changed_curve().back().force_n, insertion_n);
  keep_picture("parameters_proxy.png");
}

TEST_F(ParameterPanelTest, KeepsChangesForACaseWithTheSameTissues) {
  open_tissue("parameter-tissue-liver");
  type("parameter-liver-k", "0.5");
  settle();
  panel.show_case(opened);
  settle();
  ASSERT_EQ(sent.size(), 2u) << "the new case's server is told";
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.k=0.5")});
  panel.show_case(nullptr);
  settle();
  EXPECT_TRUE(panel.settings().isEmpty());
}

TEST_F(ParameterPanelTest, AppliesHandWrittenSettingsAsOneUndoStep) {
  // skin is the first tissue with its layer and has one viscosity: nu is both laws'.
  const Status done = panel.apply_settings(
      {QStringLiteral("liver_capsule.stiffness_n_per_mm=0.9"), QStringLiteral("layers.skin.fp=4"),
       QStringLiteral("tissues.liver.friction_mu=0.25"), QStringLiteral("skin.viscosity_ns_per_mm=0.05")});
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_EQ(panel.settings(), (QStringList{QStringLiteral("skin.nu=0.05"), QStringLiteral("skin.fp=4"),
                                           QStringLiteral("liver.k=0.9"), QStringLiteral("liver.mu=0.25")}));
  const QStringList before = panel.settings();
  // The last of two counts, also where it gives the default back under another name.
  ASSERT_TRUE(panel.apply_settings({QStringLiteral("liver.k=0.9"), QStringLiteral("layers.liver_capsule.k=0.42")}));
  EXPECT_TRUE(panel.settings().isEmpty());
  part<QToolButton>("parameter-undo")->click();
  EXPECT_EQ(panel.settings(), before);
  for (const char* bad :
       {"liver.k=51", "liver.weight=1", "nothing.k=1", "liver.k", "layers.skin.nu=0.05", "skin.wall=0"}) {
    const Status refused = panel.apply_settings({QStringLiteral("liver.mu=0.3"), QString::fromLatin1(bad)});
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().exit_status, 2) << bad;
    EXPECT_EQ(panel.settings(), before) << bad;
  }
  part<QToolButton>("parameter-undo")->click();
  EXPECT_TRUE(panel.settings().isEmpty());
}

TEST_F(ParameterPanelTest, ScrollsAnOpenedTissueIntoView) {
  auto* scroll = panel.findChild<QScrollArea*>();
  const auto top_of = [&](const char* name) {
    return part<QPushButton>(name)->mapTo(scroll->viewport(), QPoint()).y();
  };
  const int height = scroll->viewport()->height();
  ASSERT_GT(top_of("parameter-tissue-transfer"), height);
  open_tissue("parameter-tissue-transfer");
  settle();
  EXPECT_GE(top_of("parameter-tissue-transfer"), 0);
  EXPECT_LT(top_of("parameter-tissue-transfer"), height / 4) << "and its rows below";
  keep_picture("parameters_scrolled.png");
  open_tissue("parameter-tissue-skin");
  settle();
  EXPECT_GE(top_of("parameter-tissue-skin"), 0);
  EXPECT_LT(top_of("parameter-tissue-skin"), height / 4);
}

TEST_F(ParameterPanelTest, FitsIn340By700Pixels) {
  open_tissue("parameter-tissue-skin");
  keep_picture("parameters_340.png");
  EXPECT_EQ(panel.width(), 340);
  for (auto* label : panel.findChildren<QLabel*>())
    if (label->isVisible() && !label->text().isEmpty()) {
      EXPECT_GE(label->width(), label->wordWrap() ? 0 : label->sizeHint().width()) << label->text().toStdString();
    }
  for (auto* button : panel.findChildren<QAbstractButton*>())
    if (button->isVisible()) {
      EXPECT_GE(button->width(), button->minimumSizeHint().width()) << button->objectName().toStdString();
      const int right = button->mapTo(&panel, QPoint(button->width(), 0)).x();
      EXPECT_LE(right, panel.width()) << button->objectName().toStdString();
    }
}

TEST_F(ParameterPanelTest, AllHeadersFitWhenAllTissuesAreChanged) {
  QStringList all;
  std::vector<std::string> groups;
  for (const anatomy::TissueParameterGroup& group : anatomy::tissue_parameters(opened->the_case.tissues)) {
    groups.push_back(group.name);
    for (const anatomy::TissueParameter& parameter : group.parameters)
      if (parameter.key == "mu" || parameter.key == "tn")
        all << QString::fromStdString(parameter.setting) + QStringLiteral("=1.2");
  }
  ASSERT_TRUE(panel.apply_settings(all));
  settle();
  keep_picture("parameters_all_changed.png");
  auto* scroll = panel.findChild<QScrollArea*>();
  EXPECT_LE(scroll->widget()->width(), scroll->viewport()->width());
  for (const std::string& name : groups) {
    auto* header = part<QPushButton>(("parameter-tissue-" + name).c_str());
    EXPECT_TRUE(header->text().contains(QStringLiteral("changed"))) << name;
    EXPECT_GE(header->width(), header->sizeHint().width()) << name;
  }
}

TEST(ParameterScale, MapsPositionsToNumbersAndBack) {
  for (const auto& [low, high, log_from] : {std::tuple(0.001, 50.0, 0.001), std::tuple(0.0, 1.0, 1e-4),
                                            std::tuple(0.0, 2.0, 0.0), std::tuple(0.0, 1e6, 0.1)}) {
    anatomy::TissueParameter parameter;
    parameter.low = low;
    parameter.high = high;
    parameter.log_from = log_from;
    const ParameterScale scale(parameter);
    double last = -1.0;
    for (int position = 0; position <= ParameterScale::kSteps; ++position) {
      const double value = scale.value_at(position);
      EXPECT_GE(value, last);
      EXPECT_NEAR(scale.position_of(value), position, 3.0) << "three digits";
      last = value;
    }
    EXPECT_EQ(scale.value_at(0), low);
    EXPECT_EQ(last, high);
  }
}

}  // namespace
}  // namespace trocar::trainer
