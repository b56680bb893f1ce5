// The recorded ultrasound of the case builder, as an instructor registers it.
#include <QCheckBox>
#include <QLabel>
#include <QTableWidget>

#include "case_builder/case_files.h"
#include "case_builder/ultrasound.h"
#include "core/random.h"
#include "io/patient/patient_extras.h"
#include "test/case_builder_lab.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {
namespace fs = std::filesystem;

const Vec3 kOffset_mm(9.0, -7.0, 5.0);  ///< From the ultrasound's frame to the CT.

/// Gray levels of a part of the patient with noise: an "ultrasound" whose pose is known. Beams along +y.
void write_ultrasound(const volume::CtGrid& ct, const fs::path& path) {
  volume::GridGeometry grid;
  grid.size = {60, 50, 50};
  grid.spacing_mm = Vec3::Constant(2.0);
  const Vec3 middle_P = ct.geometry.to_mm(0.5 * volume::to_vec3(ct.geometry.size));
  grid.origin_P = middle_P - grid.to_mm(0.5 * volume::to_vec3(grid.size)) - kOffset_mm;
  volume::LabelGrid gray(grid);
  for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
    const double hu = volume::sample_linear(ct, grid.centre_mm(grid.index_of(n)) + kOffset_mm);
    const double level = 110.0 + 0.6 * (hu - 40.0) + 30.0 * (uniform01(1, n) - 0.5);
    gray.voxels[n] = static_cast<std::uint8_t>(std::clamp(level, 25.0, 255.0));
  }
  ASSERT_TRUE(io::write_image(gray, path));
}

class CaseUltrasoundTest : public CasePageTest {
 protected:
  void read_ultrasound() {
    import_files();
    ASSERT_TRUE(wait_for_review());
    write_ultrasound(page_.editor().patient()->ct, file());
    press("case-step-6");
    find<QLineEdit>("case-us-file").setText(to_qt(file().string()));
    press("case-us-read");
    ASSERT_TRUE(wait_for_work());
    ASSERT_TRUE(draft().ultrasound) << page_.editor().message();
  }
  /// Four pairs by clicks in both volumes, each a pixel off at most.
  void place_pairs() {
    const Vec3 middle_U = middle_of(*draft().ultrasound);
    const Vec3 offsets[] = {{30.0, 5.0, 0.0}, {-28.0, 12.0, 0.0}, {5.0, -20.0, 24.0}, {0.0, 22.0, -22.0}};
    press("case-pair-pick");
    for (const Vec3& offset : offsets) {
      press("case-pair-new");
      auto& axial = find<SliceView>("slice-axial");
      auto& lateral = find<SliceView>("us-lateral");
      axial.set_focus(middle_U + offset + kOffset_mm);
      lateral.set_focus(middle_U + offset);
      click(axial, middle_U + offset + kOffset_mm);
      click(lateral, middle_U + offset);
    }
    press("case-pair-pick");
    page_.advance();
  }
  fs::path file() const { return folder_ / "us.nrrd"; }
  const case_builder::CaseDraft& draft() { return page_.editor().draft(); }
  double error_mm() { return (draft().placement->X_PU * middle_of(*draft().ultrasound) - true_middle_P()).norm(); }
  Vec3 true_middle_P() { return middle_of(*draft().ultrasound) + kOffset_mm; }

  TemporaryFolder folder_;
};

TEST_F(CaseUltrasoundTest, IsPlacedByLandmarksRegisteredComparedAndSaved) {
  read_ultrasound();
  EXPECT_FALSE(find<QPushButton>("case-pair-fit").isEnabled());
  EXPECT_FALSE(find<QPushButton>("case-us-register").isEnabled()) << "no pose to start from";
  place_pairs();
  ASSERT_EQ(draft().ultrasound_landmarks.size(), 4U);
  press("case-pair-fit");
  page_.advance();
  ASSERT_TRUE(draft().placement) << page_.editor().message();
  EXPECT_LT(error_mm(), 3.0) << "a pixel of a small view";
  EXPECT_TRUE(find<QTableWidget>("case-pairs").item(0, 3)->text().contains(QStringLiteral("mm")));
  auto& axial = find<SliceView>("slice-axial");
  auto& lateral = find<SliceView>("us-lateral");
  EXPECT_LT((axial.focus() - draft().placement->X_PU * lateral.focus()).norm(), 1e-9) << "they move together";

  press("case-us-register");
  page_.advance();
  EXPECT_TRUE(find<QPushButton>("case-cancel").isVisible());
  ASSERT_TRUE(wait_for_work());
  page_.advance();
  ASSERT_EQ(draft().placement->origin, case_builder::PlacementOrigin::kOptimised) << page_.editor().message();
  EXPECT_LT(error_mm(), 1.0);
  EXPECT_TRUE(find<QLabel>("case-us-pose").text().contains(QStringLiteral("confidence")));
  wheel(lateral, lateral.picture_rect().center(), 240);
  EXPECT_LT((axial.focus() - draft().placement->X_PU * lateral.focus()).norm(), 1e-9);

  const QImage blend = axial.grab().toImage();
  find<QComboBox>("case-us-fusion").setCurrentText(QStringLiteral("Checkerboard"));
  const QImage board = axial.grab().toImage();
  find<QComboBox>("case-us-fusion").setCurrentText(QStringLiteral("Off"));
  const QImage ct = axial.grab().toImage();
  EXPECT_NE(blend, ct);
  EXPECT_NE(board, ct);
  EXPECT_NE(board, blend);
  find<QComboBox>("case-us-fusion").setCurrentText(QStringLiteral("Blend"));
  save(page_, "case_ultrasound.png");

  press("case-undo");
  EXPECT_EQ(draft().placement->origin, case_builder::PlacementOrigin::kLandmarks);
  press("case-redo");
  find<QCheckBox>("case-us-used").click();
  EXPECT_TRUE(uses_recorded_ultrasound(draft()));
  press("case-step-7");
  const fs::path case_folder = folder_ / "case";
  find<QLineEdit>("case-folder").setText(to_qt(case_folder.string()));
  press("case-save");
  ASSERT_TRUE(wait_for_work());
  const auto panorama = io::load_panorama({case_folder.string()});
  ASSERT_TRUE(panorama) << panorama.error().text() << page_.editor().message();
  EXPECT_LT(((*panorama)->X_PU.p() - draft().placement->X_PU.p()).norm(), 1e-6);
  const auto again = case_builder::import_case({case_folder.string(), {}});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->ultrasound_landmarks.size(), 4U);
  EXPECT_TRUE(uses_recorded_ultrasound(*again));
}

TEST_F(CaseUltrasoundTest, CancelledRegistrationAndABrokenFileChangeNothing) {
  read_ultrasound();
  find<QComboBox>("case-us-start").setCurrentIndex(2);
  press("case-us-register");
  page_.advance();
  press("case-cancel");
  page_.advance();
  EXPECT_EQ(page_.editor().work(), case_builder::CaseEditor::Work::kNone);
  EXPECT_FALSE(draft().placement);
  const case_builder::CaseDraft before = draft();
  ASSERT_TRUE(write_file_atomically(folder_ / "broken.nrrd", "NRRD0004\nno volume"));
  find<QLineEdit>("case-us-file").setText(to_qt((folder_ / "broken.nrrd").string()));
  press("case-us-read");
  ASSERT_TRUE(wait_for_work());
  EXPECT_TRUE(page_.editor().is_error());
  EXPECT_TRUE(find<QLabel>("case-message").text().contains(QStringLiteral("broken.nrrd")));
  EXPECT_TRUE(case_builder::is_same_draft(draft(), before));
  press("case-us-remove");
  EXPECT_FALSE(draft().ultrasound);
  press("case-undo");
  EXPECT_TRUE(draft().ultrasound);
}

TEST_F(CaseUltrasoundTest, SelectingALandmarkMovesBothSliceViewsToIt) {
  read_ultrasound();
  place_pairs();
  auto& list = find<QTableWidget>("case-pairs");
  ASSERT_GE(list.rowCount(), 4);
  Q_EMIT list.cellClicked(1, 0);
  EXPECT_LT((find<SliceView>("us-lateral").focus() - draft().ultrasound_landmarks[1].p).norm(), 1e-9);
  EXPECT_LT((find<SliceView>("slice-axial").focus() - draft().landmarks[1].p_P).norm(), 1e-9);
  list.selectRow(1);
  press_key(list, Qt::Key_Delete);
  EXPECT_EQ(draft().ultrasound_landmarks.size(), 3U);
  EXPECT_EQ(draft().landmarks.size(), 4U) << "the case keeps its own";
  press("case-undo");
  EXPECT_EQ(draft().ultrasound_landmarks.size(), 4U);
}

}  // namespace
}  // namespace trocar::trainer
