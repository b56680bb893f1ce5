#pragma once

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPushButton>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "core/files/folders.h"
#include "parameters/force_preview.h"
#include "parameters/parameter_panel.h"
#include "test/open_abdomen.h"

namespace trocar::trainer {

/// A parameter panel with the embedded patient and an empty folder for profiles.
class ParameterLab : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    opened = open_abdomen();
    ASSERT_NE(opened, nullptr);
  }

  void SetUp() override {
    panel.set_profile_folder(folder / "profiles");
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

  /// Runs frames until every change was sent and predicted.
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

  /// Device travel at which a layer is punctured.
  double way_mm(const char* layer) const {
    const auto& curve = panel.preview().changed_curve();
    for (const cases::CurveEvent& event : cases::find_curve_events(curve, opened->the_case.tissues))
      if (event.layer == layer) return event.way_mm;
    return -1.0;
  }

  void keep_picture(const char* name) {
    QCoreApplication::processEvents();
    if (const QString place = qEnvironmentVariable("TROCAR_TEST_PICTURES"); !place.isEmpty())
      panel.grab().save(place + QLatin1Char('/') + QString::fromLatin1(name));
  }

  static inline std::shared_ptr<const cases::OpenCase> opened;
  TemporaryFolder folder;
  ParameterPanel panel;
  std::vector<QStringList> sent;
  std::vector<QString> models;
};

}  // namespace trocar::trainer
