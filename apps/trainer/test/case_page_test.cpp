// The case builder as an instructor uses it: import, target, path, save, open again.
#include "pages/case_page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMouseEvent>
#include <QPushButton>
#include <QTabWidget>
#include <QTableWidget>
#include <QThread>
#include <QTimer>
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "case_builder/case_edits.h"
#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/test_data.h"
#include "io/image/image_file.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "test/case_builder_lab.h"
#include "test/widget_actions.h"
#include "ui_kit/parts.h"
#include "views/slices/slice_view.h"

namespace trocar::trainer {
namespace {
namespace fs = std::filesystem;

TEST_F(CasePageTest, MirroredLabelsAreRepairedOrConfirmed) {
  const TemporaryFolder folder;
  auto labels = io::read_labels(*files_ / "labels.nrrd");
  ASSERT_TRUE(labels) << labels.error().text();
  const auto width = static_cast<std::ptrdiff_t>(labels->geometry.size[0]);
  for (auto row = labels->voxels.begin(); row != labels->voxels.end(); row += width) std::reverse(row, row + width);
  ASSERT_TRUE(io::write_image(*labels, folder / "mirrored.nrrd"));
  const auto import_mirrored = [&] {
    import((*files_ / "ct.nrrd").string(), (folder / "mirrored.nrrd").string(), (*files_ / "names.toml").string());
    ASSERT_TRUE(wait_for_work());
    ASSERT_TRUE(find<QLabel>("case-finding").isVisible()) << page_.editor().message();
  };
  import_mirrored();
  EXPECT_FALSE(page_.editor().has_patient());
  EXPECT_TRUE(find<QLabel>("case-finding").text().contains(QStringLiteral("mirrored")));
  save_steps("finding");
  press("case-finding-repair");
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  EXPECT_FALSE(find<QLabel>("case-finding").isVisible());
  const auto has_line = [&](const std::string& words) {
    return std::ranges::any_of(page_.editor().draft().provenance,
                               [&](const std::string& line) { return line.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(has_line("mirrored left to right: labels"));
  import_mirrored();
  press("case-finding-confirm");
  ASSERT_TRUE(wait_for_work());
  EXPECT_TRUE(has_line("confirmed: mirrored")) << page_.editor().message();
}

TEST_F(CasePageTest, ConfirmsAFindingAndUndoesIt) {
  // The CT table is in front of the body: a prone scan.
  const TemporaryFolder folder;
  auto ct = io::read_ct(*files_ / "ct.nrrd");
  ASSERT_TRUE(ct) << ct.error().text();
  const volume::GridGeometry& g = ct->geometry;
  std::int64_t skin = g.size[1];
  for (std::size_t n = 0; n < ct->voxels.size(); ++n)
    if (ct->voxels[n] > -300) skin = std::min(skin, g.index_of(n)[1]);
  const auto away =
      static_cast<std::int64_t>(std::lround(14.0 / g.spacing_mm.y()));  // beyond the blocks next to the body
  ASSERT_GE(skin, away + 1);
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t i = g.size[0] / 5; i < g.size[0] * 4 / 5; ++i) (*ct)[{i, skin - away, k}] = -200;
  ASSERT_TRUE(io::write_image(*ct, folder / "prone.nrrd"));
  import((folder / "prone.nrrd").string(), (*files_ / "labels.nrrd").string(), (*files_ / "names.toml").string());
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  ASSERT_TRUE(find<QLabel>("case-finding").isVisible());
  EXPECT_TRUE(find<QLabel>("case-finding").text().contains(QStringLiteral("table")))
      << to_std(find<QLabel>("case-finding").text());
  save_steps("told");
  press("case-step-1");
  press("case-finding-confirm");
  page_.advance();
  EXPECT_FALSE(find<QLabel>("case-finding").isVisible()) << to_std(find<QLabel>("case-finding").text());
  EXPECT_TRUE(page_.editor().draft().provenance.back().starts_with("confirmed: posture"));
  page_.editor().undo();
  QCoreApplication::processEvents();
  page_.advance();
  EXPECT_TRUE(find<QLabel>("case-finding").isVisible());
  press("case-finding-repair");
  ASSERT_TRUE(wait_for_work());
  EXPECT_EQ(page_.editor().draft().imported->patient.posture, anatomy::Posture::kProne);
  EXPECT_FALSE(find<QLabel>("case-finding").isVisible());
}

TEST_F(CasePageTest, SavesAndReopensACaseMadeByClicks) {
  const TemporaryFolder folder;
  import_files();
  ASSERT_TRUE(wait_for_review());

  press("case-step-3");
  const Vec3& target_P = reachable_P_;
  press("case-target-pick");
  auto& axial = find<SliceView>("slice-axial");
  axial.set_focus(target_P);
  click(axial, target_P);
  ASSERT_TRUE(page_.editor().draft().task.target_P);
  EXPECT_LT((*page_.editor().draft().task.target_P - target_P).norm(), 1.5);  // a pixel
  press("case-undo");
  page_.advance();
  EXPECT_FALSE(page_.editor().draft().task.target_P);
  press("case-redo");
  EXPECT_TRUE(page_.editor().draft().task.target_P);

  press("case-step-4");
  press("case-plan");
  ASSERT_TRUE(wait_for_work());
  const anatomy::NeedlePath* path = case_builder::find_expert_path(page_.editor().draft());
  ASSERT_NE(path, nullptr) << page_.editor().message();
  const Segment planned_P = path->line_P;
  press("case-zone-pick");
  axial.set_focus(planned_P.a);
  click(axial, planned_P.a);
  ASSERT_TRUE(page_.editor().draft().task.entry_zone);
  EXPECT_LT((page_.editor().draft().task.entry_zone->centre_P - planned_P.a).norm(), 3.0);
  press("case-entry-pick");
  axial.set_focus(planned_P.a);
  click(axial, planned_P.a);
  EXPECT_GT((case_builder::find_expert_path(page_.editor().draft())->line_P.a - planned_P.a).norm(), 0.0);
  EXPECT_LT((case_builder::find_expert_path(page_.editor().draft())->line_P.a - planned_P.a).norm(), 3.0);
  press("case-undo");  // a planned path may keep its margins just so
  ASSERT_TRUE(wait_for_review());
  EXPECT_EQ(errors(case_builder::CaseStep::kPath), 0);
  press("case-step-5");
  ASSERT_TRUE(page_.editor().preview());
  EXPECT_GE(find<QTableWidget>("case-force-events").rowCount(), 2);

  place_landmarks();
  save_steps("case");
  press("case-step-7");
  find<QLineEdit>("case-name").setText(QStringLiteral("From clicks"));
  Q_EMIT find<QLineEdit>("case-name").textEdited(QStringLiteral("From clicks"));
  const fs::path case_folder = folder.path() / "case";
  find<QLineEdit>("case-folder").setText(to_qt(case_folder.string()));
  EXPECT_FALSE(find<QPushButton>("case-open").isEnabled());
  press("case-save");
  ASSERT_TRUE(wait_for_work());
  ASSERT_FALSE(page_.editor().is_error()) << page_.editor().message();
  ASSERT_TRUE(fs::exists(case_folder / "task.toml"));
  std::vector<std::string> opened;
  QObject::connect(&page_, &CasePage::case_saved, [&](const QString& at) { opened.push_back(to_std(at)); });
  press("case-open");
  EXPECT_EQ(opened, std::vector<std::string>{case_folder.string()});

  auto patient = io::load_patient(case_folder);
  ASSERT_TRUE(patient) << patient.error().text();
  ASSERT_EQ(patient->landmarks.size(), 2U);
  EXPECT_EQ(patient->landmarks[0].name, "xiphoid process");
  EXPECT_EQ(patient->landmarks[1].name, "where the drain was");
  cases::CaseOptions options;
  options.task.clear();
  options.patient_folder = case_folder.string();
  const auto the_case =
      cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(*patient)), options);
  ASSERT_TRUE(the_case) << the_case.error().text();
  const case_builder::CaseDraft made = page_.editor().draft();
  EXPECT_LT((the_case->plan.line_P.a - case_builder::find_expert_path(made)->line_P.a).norm(), 1e-6);

  import(case_folder.string(), "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  case_builder::CaseDraft again = page_.editor().draft();
  again.imported = made.imported;
  EXPECT_TRUE(case_builder::is_same_draft(again, made));
}

TEST_F(CasePageTest, RealCtBecomesACase) {
  const fs::path data = trocar::testing::test_data() / "ct-torso";
  if (!fs::exists(data)) GTEST_SKIP() << "no real data at " << data;
  import((data / "example_ct.nii.gz").string(), (data / "example_seg_fast_force_split.nii.gz").string(),
         "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  ASSERT_TRUE(wait_for_review());
  EXPECT_GT(find<QTableWidget>("case-label-table").rowCount(), 30);
  EXPECT_GT(find<QListWidget>("case-checks").count(), 3);
  press("case-step-4");
  press("case-plan");
  ASSERT_TRUE(wait_for_work());
  ASSERT_NE(case_builder::find_expert_path(page_.editor().draft()), nullptr) << page_.editor().message();
  ASSERT_TRUE(wait_for_review());
  EXPECT_EQ(errors(case_builder::CaseStep::kPath), 0);
  save_steps("case_torso");
}

TEST_F(CasePageTest, FailedImportShowsOneLineAndKeepsTheDraft) {
  import("layers-liver", "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  const case_builder::CaseDraft before = page_.editor().draft();
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "ct.nrrd", "NRRD0004\nno volume"));
  import((folder / "ct.nrrd").string(), (folder / "ct.nrrd").string(), "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  EXPECT_TRUE(page_.editor().is_error());
  const QString text = find<QLabel>("case-message").text();
  EXPECT_FALSE(text.isEmpty());
  EXPECT_FALSE(text.contains(QLatin1Char('\n')));
  EXPECT_TRUE(case_builder::is_same_draft(page_.editor().draft(), before));
}

TEST_F(CasePageTest, OnlyImportsThatSucceededAreRecent) {
  const auto& recent = find<QListWidget>("case-recent");
  const int before = recent.count();
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "broken.nrrd", "NRRD0004\nno volume"));
  import((folder / "broken.nrrd").string(), (folder / "broken.nrrd").string(), "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  EXPECT_TRUE(page_.editor().is_error());
  EXPECT_EQ(recent.count(), before);
  for (int row = 0; row < recent.count(); ++row)
    EXPECT_FALSE(recent.item(row)->toolTip().contains(QStringLiteral("broken")));
  import("layers-liver", "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  ASSERT_GE(recent.count(), 1);
  EXPECT_EQ(recent.item(0)->toolTip(), QStringLiteral("layers-liver"));
}

TEST_F(CasePageTest, NewFilesReplaceThoseOfAFailedImport) {
  auto& labels = find<QLineEdit>("case-labels");
  const auto choose = [&](const fs::path& file) {
    QTimer::singleShot(0, &page_, [&] {
      auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
      ASSERT_NE(dialog, nullptr);
      dialog->selectFile(to_qt(file.string()));
      QMetaObject::invokeMethod(dialog, "accept");
    });
    press("case-labels-files");
  };
  const TemporaryFolder folder;
  for (const char* name : {"one.nrrd", "two.nrrd"}) ASSERT_TRUE(write_file_atomically(folder / name, "none"));
  choose(folder / "one.nrrd");
  choose(folder / "two.nrrd");
  EXPECT_EQ(labels.text().count(QLatin1Char(';')), 1) << "several are added up";
  import("layers-liver", "/nowhere/labels.nrrd", "totalsegmentator");
  // It fails before the page's next frame.
  for (int n = 0; n < 30'000 && !page_.editor().work_view().is_done; ++n) QThread::msleep(1);
  ASSERT_TRUE(page_.editor().work_view().is_done);
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().is_error());
  choose(folder / "one.nrrd");
  EXPECT_EQ(labels.text(), to_qt((folder / "one.nrrd").string()));
}

TEST_F(CasePageTest, RemoveButtonsNameWhatTheyRemove) {
  EXPECT_EQ(find<QPushButton>("case-zone-clear").text(), QStringLiteral("Remove entry zone"));
  EXPECT_EQ(find<QPushButton>("case-path-clear").text(), QStringLiteral("Remove path"));
}

TEST_F(CasePageTest, CancelledImportLeavesThePageUnchanged) {
  start_import_of_files();
  page_.advance();
  EXPECT_TRUE(find<QPushButton>("case-cancel").isVisible());
  press("case-cancel");
  page_.advance();
  EXPECT_EQ(page_.editor().work(), case_builder::CaseEditor::Work::kNone);
  EXPECT_FALSE(page_.editor().has_patient());
  EXPECT_FALSE(find<QPushButton>("case-cancel").isVisible());
}

TEST_F(CasePageTest, LabelsAndRisksAreEditedWithUndo) {
  import("layers-liver", "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  ASSERT_TRUE(page_.editor().has_patient()) << page_.editor().message();
  press("case-step-2");
  auto& table = find<QTableWidget>("case-label-table");
  ASSERT_GT(table.rowCount(), 1);
  table.selectRow(0);
  auto& name = find<QLineEdit>("case-label-name");
  const QString before = name.text();
  name.setText(QStringLiteral("renamed"));
  Q_EMIT name.editingFinished();
  page_.advance();
  EXPECT_EQ(table.item(0, 0)->text(), QStringLiteral("renamed"));
  press("case-undo");
  page_.advance();
  EXPECT_EQ(table.item(0, 0)->text(), before);
  EXPECT_FALSE(find<QPushButton>("case-undo").isEnabled());

  press("case-step-3");
  auto& risks = find<QTableWidget>("case-risk-table");
  const int rows = risks.rowCount();
  risks.selectRow(0);
  press("case-risk-remove");
  page_.advance();
  EXPECT_EQ(risks.rowCount(), rows - 1);
  press("case-undo");
  page_.advance();
  EXPECT_EQ(risks.rowCount(), rows);
}

TEST_F(CasePageTest, EditsLandmarksWithUndo) {
  import("layers-liver", "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  press("case-step-3");
  const auto& landmarks = [&]() -> const std::vector<anatomy::Landmark>& { return page_.editor().draft().landmarks; };
  auto& axial = find<SliceView>("slice-axial");
  auto& list = find<QListWidget>("case-landmarks");
  find<QTabWidget>("case-target-tabs").setCurrentIndex(1);
  find<QComboBox>("case-landmark-name").setEditText(QStringLiteral("spinous process L3"));
  press("case-landmark-pick");
  EXPECT_TRUE(find<QLabel>("case-click-text").text().contains(QStringLiteral("spinous process L3")));
  const std::size_t before = landmarks().size();  // the patient's own
  const Vec3 first_P = axial.focus() + Vec3(10.0, -12.0, 0.0);
  click(axial, first_P);
  page_.advance();
  ASSERT_EQ(landmarks().size(), before + 1);
  const auto n = static_cast<int>(before);
  EXPECT_EQ(landmarks()[before].name, "spinous process L3");
  EXPECT_LT((landmarks()[before].p_P - first_P).norm(), 2.5);  // a pixel
  EXPECT_EQ(list.item(n)->text(), QStringLiteral("spinous process L3"));

  // The tool stays: another click moves it, another name places another one.
  const Vec3 second_P = first_P + Vec3(0.0, 20.0, 0.0);
  click(axial, second_P);
  ASSERT_EQ(landmarks().size(), before + 1);
  EXPECT_LT((landmarks()[before].p_P - second_P).norm(), 2.5);
  press("case-undo");
  EXPECT_LT((landmarks()[before].p_P - first_P).norm(), 2.5);
  find<QComboBox>("case-landmark-name").setEditText(QStringLiteral("  "));
  click(axial, second_P);
  EXPECT_TRUE(page_.editor().is_error()) << "a landmark without a name";
  find<QComboBox>("case-landmark-name").setEditText(QStringLiteral("umbilicus"));
  click(axial, second_P);
  page_.advance();
  ASSERT_EQ(list.count(), n + 2);

  list.item(n + 1)->setText(QStringLiteral("spinous process L3"));
  page_.advance();
  EXPECT_EQ(list.item(n + 1)->text(), QStringLiteral("umbilicus")) << "the name is taken";
  list.item(n + 1)->setText(QStringLiteral("navel"));
  page_.advance();
  EXPECT_EQ(landmarks()[before + 1].name, "navel");
  Q_EMIT list.itemClicked(list.item(n));
  EXPECT_LT((find<SliceView>("slice-coronal").focus() - landmarks()[before].p_P).norm(), 1e-9);
  list.setCurrentRow(n);
  press_key(list, Qt::Key_Delete);
  page_.advance();
  ASSERT_EQ(list.count(), n + 1);
  EXPECT_EQ(list.item(n)->text(), QStringLiteral("navel"));
  press("case-undo");
  page_.advance();
  EXPECT_EQ(list.count(), n + 2);
  save(page_, "case_landmarks.png");
  press("case-step-1");
  EXPECT_FALSE(find<QLabel>("case-click-text").isVisible()) << "the tool is put away";
}

TEST_F(CasePageTest, CheckJumpsToItsLocation) {
  import("layers-liver", "", "totalsegmentator");
  ASSERT_TRUE(wait_for_work());
  page_.advance();
  const Vec3 target_P = find<SliceView>("slice-axial").focus();  // the middle of the body
  const Vec3 begin_P = target_P - Vec3(0.0, 0.0, 20.0);
  ASSERT_TRUE(page_.editor().edit(case_builder::set_expert_path(page_.editor().draft(), {begin_P, target_P}), "path"));
  ASSERT_TRUE(wait_for_review());
  EXPECT_GT(errors(case_builder::CaseStep::kPath), 0);
  auto& checks = find<QListWidget>("case-checks");
  for (int row = 0; row < checks.count(); ++row) {
    if (!checks.item(row)->text().contains(QStringLiteral("below the skin"))) continue;
    if (!checks.item(row)->text().startsWith(QStringLiteral("the path begins"))) continue;
    Q_EMIT checks.itemClicked(checks.item(row));
    EXPECT_LT((find<SliceView>("slice-axial").focus() - begin_P).norm(), 1e-6);
    return;
  }
  FAIL() << "no check about the path's begin";
}

}  // namespace
}  // namespace trocar::trainer
