#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QLineEdit>
#include <QMouseEvent>
#include <QPushButton>
#include <QTabWidget>
#include <QThread>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "io/image/image_file.h"
#include "pages/case_page.h"
#include "phantom/phantom.h"
#include "ui_kit/parts.h"
#include "views/slices/slice_view.h"

namespace trocar::trainer {

/// A small made patient as an instructor gets patients: a CT and a segmentation with a list of names. `reachable_P`: a
/// target with a safe path to it.
inline void write_case_files(const std::filesystem::path& folder, Vec3& reachable_P) {
  const auto patient = phantom::generate_phantom("abdomen", 1, {{144, 116, 104}});
  ASSERT_TRUE(patient) << patient.error().text();
  reachable_P = patient->paths.front().line_P.b;
  volume::LabelGrid labels = patient->labels;
  std::string names = "[labels]\n";
  for (const anatomy::Label& label : patient->label_table.labels) {
    const bool is_found_anew = label.tissue == "adipose" || label.tissue == "skin" || label.name == "muscle";
    if (!is_found_anew) names += fmt::format("{} = \"{}\"\n", label.id, label.name);
    if (is_found_anew)
      for (std::uint8_t& id : labels.voxels) id = id == label.id ? std::uint8_t{0} : id;
  }
  ASSERT_TRUE(io::write_image(patient->ct, folder / "ct.nrrd"));
  ASSERT_TRUE(io::write_image(labels, folder / "labels.nrrd"));
  ASSERT_TRUE(write_file_atomically(folder / "names.toml", names));
}

/// A page on the screen at the size of a small window, with a case to work at.
class CasePageTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    files_ = std::make_unique<TemporaryFolder>();
    write_case_files(files_->path(), reachable_P_);
  }
  static void TearDownTestSuite() { files_.reset(); }
  void SetUp() override {
    page_.resize(1280, 720);
    page_.show();
    QCoreApplication::processEvents();
  }

  template <class Widget>
  Widget& find(const char* name) {
    auto* widget = page_.findChild<Widget*>(QString::fromLatin1(name));
    EXPECT_NE(widget, nullptr) << name;
    return *widget;
  }
  void press(const char* name) {
    page_.advance();
    find<QPushButton>(name).click();
  }
  /// Frames until `is_there`, at most four minutes: the machine may be busy.
  template <class Condition>
  bool wait_for(Condition is_there) {
    QElapsedTimer timer;
    timer.start();
    while (!is_there() && timer.elapsed() < 240000) {
      page_.advance();
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
      QThread::msleep(2);  // the machine is the work's
    }
    page_.advance();
    return is_there();
  }
  bool wait_for_work() {
    return wait_for([&] { return page_.editor().work() == case_builder::CaseEditor::Work::kNone; });
  }
  bool wait_for_review() {
    return wait_for([&] { return page_.editor().is_reviewed(); });
  }
  void import(const std::string& ct, const std::string& labels, const std::string& map) {
    press("case-step-1");
    find<QLineEdit>("case-ct").setText(to_qt(ct));
    find<QLineEdit>("case-labels").setText(to_qt(labels));
    find<QComboBox>("case-label-map").setCurrentText(to_qt(map));
    press("case-import");
  }
  void start_import_of_files() {
    import((*files_ / "ct.nrrd").string(), (*files_ / "labels.nrrd").string(), (*files_ / "names.toml").string());
  }
  void import_files() {
    start_import_of_files();
    ASSERT_TRUE(wait_for_work());
    ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  }
  void click(SliceView& slice, const Vec3& p_P) {
    const QPointF at = slice.position_of(p_P);
    QMouseEvent down(QEvent::MouseButtonPress, at, slice.mapToGlobal(at.toPoint()), Qt::LeftButton, Qt::LeftButton, {});
    QMouseEvent up(QEvent::MouseButtonRelease, at, slice.mapToGlobal(at.toPoint()), Qt::LeftButton, Qt::NoButton, {});
    QCoreApplication::sendEvent(&slice, &down);
    QCoreApplication::sendEvent(&slice, &up);
  }
  /// Two, by clicks.
  void place_landmarks() {
    press("case-step-3");
    auto& coronal = find<SliceView>("slice-coronal");
    press("case-landmark-pick");
    find<QTabWidget>("case-target-tabs").setCurrentIndex(1);
    const Vec3 middle_P = coronal.focus();
    for (const char* name : {"xiphoid process", "where the drain was"}) {
      find<QComboBox>("case-landmark-name").setEditText(QString::fromLatin1(name));
      click(coronal, middle_P + Vec3(20.0, 0.0, name[0] == 'x' ? 40.0 : -10.0));
    }
    press("case-landmark-pick");
  }
  /// Pictures of all steps for people to look at, where TROCAR_SAVE_PICTURES names a prefix.
  void save_steps(const std::string& name) {
    if (std::getenv("TROCAR_SAVE_PICTURES") == nullptr) return;
    QElapsedTimer timer;
    timer.start();
    while (timer.elapsed() < 3000) {
      page_.advance();
      QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
    }
    for (int step = 1; step <= case_builder::kCaseSteps; ++step) {
      press(fmt::format("case-step-{}", step).c_str());
      page_.advance();
      QCoreApplication::processEvents();
      page_.grab().save(to_qt(fmt::format("{}{}_{}.png", std::getenv("TROCAR_SAVE_PICTURES"), name, step)));
    }
  }
  int errors(case_builder::CaseStep step) {
    return static_cast<int>(std::count_if(
        page_.editor().checks().begin(), page_.editor().checks().end(), [&](const case_builder::CaseCheck& check) {
          return check.step == step && check.level == case_builder::CheckLevel::kError;
        }));
  }

  static inline std::unique_ptr<TemporaryFolder> files_;
  static inline Vec3 reachable_P_ = Vec3::Zero();
  CasePage page_;
};

}  // namespace trocar::trainer
