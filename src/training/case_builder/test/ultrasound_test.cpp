#include "case_builder/ultrasound.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "case_builder/case_editor.h"
#include "case_builder/case_edits.h"
#include "case_builder/case_files.h"
#include "case_builder/checks.h"
#include "case_builder/test/made_draft.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "io/patient/patient_extras.h"
#include "io/sequence/sequence_file.h"
#include "lab/registration/generated_pair.h"
#include "registration/ct_ultrasound/rigid_registration.h"
#include "volume/sampling.h"

namespace trocar::case_builder {
namespace {
namespace fs = std::filesystem;
using namespace testing;

const registration::testing::GeneratedPair& generated_pair() {
  static const registration::testing::GeneratedPair pair = registration::testing::make_pair({});
  return pair;
}

std::shared_ptr<const ImportedUltrasound> as_ultrasound(const volume::LabelGrid& gray) {
  auto ultrasound = std::make_shared<ImportedUltrasound>();
  ultrasound->gray_U = gray;
  ultrasound->beams = *registration::Beams::along_axis("+y", gray.geometry);
  ultrasound->source = "sweep.nrrd";
  return ultrasound;
}

/// A draft whose CT is that of the generated pair.
CaseDraft pair_draft() {
  auto imported = std::make_shared<ImportedPatient>();
  imported->patient.ct = generated_pair().ct;
  imported->patient.labels = volume::LabelGrid(generated_pair().ct.geometry);
  CaseDraft draft;
  draft.imported = std::move(imported);
  return set_ultrasound(std::move(draft), as_ultrasound(generated_pair().us));
}

/// Four landmarks; those of the CT are `off_mm` to the left.
CaseDraft with_landmarks(CaseDraft draft, double off_mm) {
  const Vec3 middle_U = middle_of(*draft.ultrasound);
  const Vec3 offsets[] = {{20.0, 0.0, 5.0}, {-15.0, 18.0, 0.0}, {0.0, -12.0, 22.0}, {6.0, 10.0, -20.0}};
  int n = 0;
  for (const Vec3& offset : offsets) {
    const std::string name = "place " + std::to_string(++n);
    draft = *set_ultrasound_landmark(draft, name, middle_U + offset);
    draft = *set_landmark(draft, name, generated_pair().X_CU * (middle_U + offset) + off_mm * Vec3::UnitX());
  }
  return draft;
}

double error_mm(const Pose& X_PU) {
  const volume::LabelGrid& us = generated_pair().us;
  return *registration::mean_distance_mm(us, *registration::Beams::along_axis("+y", us.geometry), X_PU,
                                         generated_pair().X_CU);
}

TEST(CaseUltrasound, RegistersByLandmarksThenRefinesThePose) {
  const auto placed = place_by_landmarks(with_landmarks(pair_draft(), 7.0));
  ASSERT_TRUE(placed) << placed.error().text();
  ASSERT_TRUE(placed->placement);
  EXPECT_NEAR(error_mm(placed->placement->X_PU), 7.0, 1e-6);
  const auto refined = find_placement(*placed, RegistrationStart::kCurrent);
  ASSERT_TRUE(refined) << refined.error().text();
  EXPECT_LT(error_mm(refined->X_PU), 0.8);
  EXPECT_EQ(refined->origin, PlacementOrigin::kOptimised);
  EXPECT_GE(refined->confidence, registration::kLeastConfidence);
}

TEST(CaseUltrasound, RefinementNeedsAStartAndCanBeCancelled) {
  EXPECT_FALSE(find_placement(pair_draft(), RegistrationStart::kCurrent)) << "nothing to start from";
  EXPECT_FALSE(find_placement(CaseDraft{}, RegistrationStart::kHeader)) << "no ultrasound";
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(find_placement(with_landmarks(pair_draft(), 0.0), RegistrationStart::kHeader, {}, source.get_token()));
}

TEST(CaseUltrasound, UnrelatedVolumeIsRefused) {
  registration::testing::PairOptions other;
  other.seed = 99;
  const CaseDraft draft = set_ultrasound(pair_draft(), as_ultrasound(registration::testing::make_pair(other).us));
  const auto found = find_placement(draft, RegistrationStart::kHeader);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().text().find("no reliable registration"), std::string::npos) << found.error().text();
}

TEST(CaseUltrasound, RefusesImpossibleEdits) {
  CaseDraft draft = pair_draft();
  EXPECT_FALSE(set_ultrasound_landmark(CaseDraft{}, "a", Vec3::Zero())) << "no ultrasound";
  EXPECT_FALSE(set_ultrasound_landmark(draft, "", middle_of(*draft.ultrasound)));
  EXPECT_FALSE(set_ultrasound_landmark(draft, "a", middle_of(*draft.ultrasound) + Vec3(900.0, 0.0, 0.0)));
  EXPECT_FALSE(remove_ultrasound_landmark(draft, "a"));
  EXPECT_FALSE(place_by_landmarks(draft)) << "no pairs";
  EXPECT_FALSE(use_recorded_ultrasound(draft, true)) << "no pose";
  draft = with_landmarks(draft, 0.0);
  draft.landmarks[1].p_P += Vec3(60.0, 0.0, 0.0);
  const auto placed = place_by_landmarks(draft);
  ASSERT_FALSE(placed) << "not rigid";
  EXPECT_NE(placed.error().text().find("place 2"), std::string::npos) << placed.error().text();
}

TEST(CaseUltrasound, KeepsPairsOnRenameAndDropsPoseWithTheVolume) {
  CaseDraft draft = with_landmarks(pair_draft(), 0.0);
  draft = *rename_landmark(draft, 0, "portal vein");
  EXPECT_EQ(draft.ultrasound_landmarks[0].name, "portal vein");
  EXPECT_EQ(fit_of_landmarks(draft)->names.size(), 4U);
  draft = *use_recorded_ultrasound(*place_by_landmarks(draft), true);
  EXPECT_TRUE(uses_recorded_ultrasound(draft));
  draft = remove_ultrasound(draft);
  EXPECT_FALSE(draft.placement);
  EXPECT_TRUE(draft.ultrasound_landmarks.empty());
  EXPECT_FALSE(uses_recorded_ultrasound(draft));
  EXPECT_EQ(draft.landmarks.size(), 4U) << "those of the CT stay";
}

/// The patient made of shapes with a small ultrasound in its middle.
CaseDraft box_draft() {
  volume::LabelGrid gray(volume::GridGeometry{{24, 24, 24}, Vec3::Constant(2.0), Vec3::Zero(), Mat3::Identity()}, 90);
  CaseDraft draft = set_ultrasound(made_draft(), as_ultrasound(gray));
  draft = *set_ultrasound_landmark(draft, "rib 9", Vec3(10.0, 12.0, 14.0));
  draft.placement = UltrasoundPlacement{Pose::translation(Vec3(-60.0, -20.0, -10.0)), PlacementOrigin::kLandmarks, 0.0};
  return draft;
}

std::string checks_of_ultrasound(const CaseDraft& draft) {
  std::string text;
  const auto tissues = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  for (const CaseCheck& check : check_draft(draft, draft.imported->patient, shipped_needle(), *tissues))
    if (check.step == CaseStep::kUltrasound) text += std::to_string(static_cast<int>(check.level)) + check.text + "\n";
  return text;
}

TEST(CaseUltrasound, ChecksReportWhatIsMissing) {
  CaseDraft draft = box_draft();
  EXPECT_NE(checks_of_ultrasound(made_draft()).find("0no recorded ultrasound"), std::string::npos);
  EXPECT_NE(checks_of_ultrasound(draft).find("1the ultrasound is placed by landmarks only"), std::string::npos);
  draft.placement->X_PU = Pose::translation(Vec3(0.0, 0.0, 5000.0));
  EXPECT_NE(checks_of_ultrasound(draft).find("2the middle of the recorded ultrasound is outside"), std::string::npos);
  draft.placement.reset();
  EXPECT_NE(checks_of_ultrasound(draft).find("1the recorded ultrasound has no pose"), std::string::npos);
}

TEST(CaseUltrasound, SavedCaseKeepsVolumePoseLandmarksAndEngine) {
  const TemporaryFolder folder;
  DraftPatient patients;
  const CaseDraft draft = *use_recorded_ultrasound(box_draft(), true);
  const fs::path first = folder.path() / "first", again = folder.path() / "again";
  const Status saved = save_case(draft, patients, {first, false});
  ASSERT_TRUE(saved) << saved.error().text();
  auto opened = import_case({first.string(), {}});
  ASSERT_TRUE(opened) << opened.error().text();
  ASSERT_TRUE(opened->ultrasound && opened->placement);
  EXPECT_EQ(opened->ultrasound->gray_U.voxels, draft.ultrasound->gray_U.voxels);
  EXPECT_LT((opened->placement->X_PU.p() - draft.placement->X_PU.p()).norm(), 1e-6);
  ASSERT_EQ(opened->ultrasound_landmarks.size(), 1U);
  EXPECT_TRUE(uses_recorded_ultrasound(*opened));
  ASSERT_TRUE(save_case(*opened, patients, {again, false}));
  EXPECT_TRUE(io::load_panorama({again.string()}));

  ASSERT_TRUE(write_file_atomically(first / io::kPanoramaFile, "NRRD0004\nno volume"));
  opened = import_case({first.string(), {}});
  ASSERT_TRUE(opened) << "a damaged ultrasound does not lock out the patient: " << opened.error().text();
  EXPECT_FALSE(opened->ultrasound);
  ASSERT_FALSE(opened->imported->warnings.empty());
  EXPECT_NE(opened->imported->warnings.back().find("ultrasound cannot be read"), std::string::npos);
}

/// A block of 40 x 30 x 20 mm, bright in one half, by parallel images 1 mm apart.
ultrasound::TrackedSequence parallel_sweep() {
  ultrasound::TrackedSequence sweep;
  sweep.columns = 41;
  sweep.rows = 31;
  for (int frame = 0; frame <= 20; ++frame) {
    ultrasound::TrackedSequence::Frame one;
    one.time_s = 0.1 * frame;
    ultrasound::TrackedSequence::Matrix4 T = ultrasound::TrackedSequence::Matrix4::Identity();
    T(2, 3) = frame;
    one.transforms["ImageToReference"] = T;
    sweep.frames.push_back(one);
    for (int row = 0; row < sweep.rows; ++row)
      for (int column = 0; column < sweep.columns; ++column)
        sweep.pixels.push_back(column < 20 ? std::uint8_t{200} : std::uint8_t{60});
  }
  return sweep;
}

TEST(CaseUltrasound, ReconstructsATrackedSweepWithAWarning) {
  const TemporaryFolder folder;
  const fs::path file = folder / "sweep.igs.mha";
  ASSERT_TRUE(io::write_sequence(parallel_sweep(), file));
  const auto read = read_ultrasound({file, {}});
  ASSERT_TRUE(read) << read.error().text();
  const volume::GridGeometry& grid = (*read)->gray_U.geometry;
  const Vec3 extent_mm = grid.spacing_mm.cwiseProduct(volume::to_vec3(grid.size));
  EXPECT_NEAR(extent_mm.x(), 41.0, 2.0);
  EXPECT_NEAR(extent_mm.y(), 31.0, 2.0);
  EXPECT_NEAR(extent_mm.z(), 21.0, 2.0);
  EXPECT_EQ(volume::sample_nearest<std::uint8_t>((*read)->gray_U, Vec3(10.0, 15.0, 10.0), 0), 200);
  EXPECT_EQ(volume::sample_nearest<std::uint8_t>((*read)->gray_U, Vec3(30.0, 15.0, 10.0), 0), 60);
  ASSERT_EQ((*read)->warnings.size(), 1U);
  EXPECT_NE((*read)->warnings[0].find("reconstructed from 21 images"), std::string::npos) << (*read)->warnings[0];
}

TEST(CaseUltrasound, RefusesAnUncalibratedSweepWithAdvice) {
  const TemporaryFolder folder;
  const fs::path file = folder / "sweep.igs.mha";
  ultrasound::TrackedSequence sweep = parallel_sweep();
  for (auto& frame : sweep.frames) {
    frame.transforms["ProbeToTracker"] = frame.transforms["ImageToReference"];
    frame.transforms.erase("ImageToReference");
  }
  ASSERT_TRUE(io::write_sequence(sweep, file));
  const auto read = read_ultrasound({file, {}});
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().advice.find("trocar ultrasound reconstruct"), std::string::npos) << read.error().text();
}

}  // namespace
}  // namespace trocar::case_builder
