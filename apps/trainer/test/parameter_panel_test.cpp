#include "panels/parameter_panel.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSlider>
#include <QToolButton>
#include <algorithm>
#include <thread>

#include "panels/force_preview.h"
#include "panels/parameter_scale.h"
#include "script/widget_events.h"

namespace trocar::trainer {
namespace {

class ParameterPanelTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto result = make_open_case({});
    ASSERT_TRUE(result) << result.error().text();
    opened = *result;
  }
  static void TearDownTestSuite() { opened.reset(); }

  void SetUp() override {
    panel.resize(340, 700);
    QObject::connect(&panel, &ParameterPanel::parameters_changed, [this](const QStringList& s) { sent.push_back(s); });
    QObject::connect(&panel, &ParameterPanel::model_changed, [this](const QString& m) { models.push_back(m); });
    panel.show_case(opened);
    panel.show();
    panel.activateWindow();
    settle();
  }

  template <class Widget>
  Widget* part(const char* name) {
    auto* found = panel.findChild<Widget*>(QString::fromLatin1(name));
    EXPECT_NE(found, nullptr) << name;
    return found;
  }

  /// Frames until every change has been sent and predicted.
  void settle() {
    const auto begin = std::chrono::steady_clock::now();
    do {
      QCoreApplication::processEvents();
      panel.advance();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (!panel.is_settled() && std::chrono::steady_clock::now() - begin < std::chrono::minutes(2));
    EXPECT_TRUE(panel.is_settled());
  }

  void open_tissue(const char* name) {
    auto* header = part<QPushButton>(name);
    if (header != nullptr && !header->isChecked()) header->click();
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    QCoreApplication::processEvents();
  }

  static void key(QWidget& widget, int code, const QString& text = {}) {
    QKeyEvent event(QEvent::KeyPress, code, Qt::NoModifier, text);
    QCoreApplication::sendEvent(&widget, &event);
  }

  void type(const char* name, const char* text) {
    auto* field = part<QLineEdit>(name);
    ASSERT_NE(field, nullptr);
    field->setFocus();
    field->selectAll();
    for (const char* c = text; *c != '\0'; ++c) key(*field, 0, QString(QLatin1Char(*c)));
    key(*field, Qt::Key_Return);
  }

  /// Where the device is when a layer gives way.
  double way_mm(const char* layer) const {
    const auto& curve = panel.preview().changed_curve();
    for (const CurveEvent& event : find_curve_events(curve, opened->the_case.tissues))
      if (event.layer == layer) return event.way_mm;
    return -1.0;
  }

  void keep_picture(const char* name) {
    QCoreApplication::processEvents();
    if (const QString folder = qEnvironmentVariable("TROCAR_TEST_PICTURES"); !folder.isEmpty())
      panel.grab().save(folder + QLatin1Char('/') + QString::fromLatin1(name));
  }

  static inline std::shared_ptr<const OpenCase> opened;
  ParameterPanel panel;
  std::vector<QStringList> sent;
  std::vector<QString> models;
};

TEST_F(ParameterPanelTest, TissuesOnThePathComeFirst) {
  std::vector<std::string> on_path;
  for (const PathPiece& piece : opened->pieces)
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

TEST_F(ParameterPanelTest, AStifferCapsuleChangesThePredictedForceAndUndoGivesItBack) {
  open_tissue("parameter-tissue-liver");
  const double before_mm = way_mm("liver_capsule");
  const std::vector<CurvePoint> before = panel.preview().changed_curve();
  ASSERT_GT(before_mm, 0.0);
  type("parameter-liver-k", "0.05");
  EXPECT_TRUE(sent.empty()) << "waits for more";
  settle();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.k=0.05")});
  const auto expected = predict_force(opened->the_case, {"liver.k=0.05"}, "insertion");
  ASSERT_TRUE(expected);
  const auto& curve = panel.preview().changed_curve();
  ASSERT_EQ(curve.size(), expected->size());
  for (std::size_t n = 0; n < curve.size(); ++n) ASSERT_EQ(curve[n].force_n, (*expected)[n].force_n);
  EXPECT_GT(way_mm("liver_capsule"), before_mm + 0.2) << "a softer capsule gives way later";
  keep_picture("parameters_changed.png");

  EXPECT_TRUE(strike(panel, QStringLiteral("Ctrl+Z")));
  EXPECT_EQ(part<QLineEdit>("parameter-liver-k")->text(), QStringLiteral("0.42"));
  settle();
  EXPECT_EQ(sent.back(), QStringList());
  EXPECT_EQ(panel.preview().changed_curve().size(), before.size());
  EXPECT_EQ(way_mm("liver_capsule"), before_mm);
  EXPECT_TRUE(strike(panel, QStringLiteral("Ctrl+Shift+Z")));
  settle();
  EXPECT_EQ(sent.back(), QStringList{QStringLiteral("liver.k=0.05")});
}

TEST_F(ParameterPanelTest, ADraggedSliderIsOneStepAndOneMessage) {
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

TEST_F(ParameterPanelTest, RefusesWhatIsOutOfRangeAndSaysTheRange) {
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
  TissueTable table = opened->the_case.tissues;
  for (const QString& setting : panel.settings()) EXPECT_TRUE(apply_override(table, setting.toStdString()));
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

TEST_F(ParameterPanelTest, AnotherForceModelIsToldAndPredicted) {
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

TEST_F(ParameterPanelTest, ChangesOutliveAnotherCaseWithTheSameTissues) {
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

TEST_F(ParameterPanelTest, NothingIsCutOffAt340By700) {
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

TEST(ParameterScale, PositionsAndNumbersBelongTogether) {
  for (const auto& [low, high, log_from] : {std::tuple(0.001, 50.0, 0.001), std::tuple(0.0, 1.0, 1e-4),
                                            std::tuple(0.0, 2.0, 0.0), std::tuple(0.0, 1e6, 0.1)}) {
    TissueParameter parameter;
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
