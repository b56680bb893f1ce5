#include "cases/open_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include "core/files/folders.h"
#include "core/progress.h"
#include "io/patient/patient_cache.h"
#include "ultrasound/probe/probe_contact.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::cases {
namespace {

class OpenedCase : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    BackgroundJob<std::shared_ptr<const OpenCase>> job =
        open_case({}, OpenOptions{nullptr, io::patient_cache_folder()});
    while (!job.view().is_done) {
      steps.insert(job.view().step);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    auto result = job.take();
    ASSERT_TRUE(result && *result) << result->error().text();
    opened = **result;
  }
  static inline std::shared_ptr<const OpenCase> opened;
  static inline std::set<std::string> steps;
};

TEST_F(OpenedCase, HoldsAllDisplayedData) {
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->the_case.task.name, "liver-biopsy");
  opened->later->wait();
  EXPECT_FALSE(opened->later->surfaces_after(0).empty());
  EXPECT_TRUE(opened->later->acoustic());
  EXPECT_TRUE(opened->later->errors().empty());
  EXPECT_TRUE(opened->flow->is_possible());
  EXPECT_EQ(opened->pieces.front().name, "skin");
  EXPECT_EQ(opened->force_model, "insertion");
  EXPECT_GT(steps.size(), 2u);
}

TEST_F(OpenedCase, BreathesAsTheTaskSays) {
  const auto breathing = [](const std::string& text, std::uint64_t seed, std::optional<double> held_phase = {}) {
    CaseOptions options;
    options.breathing = text;
    options.level = "basic";  // 4 mm
    options.seed = seed;
    options.held_phase = held_phase;
    return prepare_case(opened->the_case.patient, options)->breathing;
  };
  const motion::MotionDrive quiet = breathing("", 5);
  EXPECT_TRUE(motion::moves(quiet));
  EXPECT_EQ(quiet, breathing("4", 5)) << "said by the task or by the options";
  EXPECT_NE(quiet, breathing("", 6)) << "another attempt, other breaths";
  EXPECT_LE(quiet.begins_s, 0.0);
  EXPECT_GT(quiet.begins_s, -quiet.period_s);
  EXPECT_FALSE(motion::moves(breathing("none", 5)));
  EXPECT_TRUE(breathing("", 5, 0.5).is_held);
  auto still = std::make_shared<anatomy::VirtualPatient>(*opened->the_case.patient);
  still->motion = nullptr;
  CaseOptions basic;
  basic.level = "basic";
  EXPECT_FALSE(motion::moves(prepare_case(still, basic)->breathing)) << "a patient without a model rests";
}

TEST_F(OpenedCase, PredictsThreePunctures) {
  const auto events = find_curve_events(opened->predicted, opened->the_case.tissues);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[2].layer, "liver_capsule");
}

TEST_F(OpenedCase, PutsTheTransducerInPlaneBesideTheEntry) {
  EXPECT_TRUE(opened->is_in_plane) << (opened->notes.empty() ? "" : opened->notes.front());
  const Pose X_TP = opened->X_PT_start.inverse();
  const Segment path_T{X_TP * opened->the_case.plan.line_P.a, X_TP * opened->the_case.plan.line_P.b};
  EXPECT_NEAR(path_T.a.z(), 0.0, 1e-6);
  EXPECT_NEAR(path_T.b.z(), 0.0, 1e-6);
  const ultrasound::ScanGeometry scan =
      ultrasound::make_scan_geometry(opened->transducer, opened->probe_depth_mm, 65, 64);
  EXPECT_GT(std::abs(path_T.a.x()), std::abs(scan.line_origin(0).x()));  // the needle's place is free
  const ultrasound::Polar target = scan.to_polar({path_T.b.x(), path_T.b.y()});
  EXPECT_GE(target.line, 0.0);
  EXPECT_LE(target.line, 64.0);
  EXPECT_LT(target.depth_mm, opened->probe_depth_mm);
  std::vector<ultrasound::LineContact> contact(65);
  ultrasound::find_contact(opened->the_case.patient->skin_distance_mm, scan, opened->X_PT_start, contact);
  const auto touching = std::count_if(contact.begin(), contact.end(), [](const auto& c) { return c.coupling > 0.5F; });
  EXPECT_GT(touching, 52);
}

TEST_F(OpenedCase, NeutralStartShowsAnotherView) {
  const NeutralStart& start = opened->neutral;
  EXPECT_EQ(start.note, "");
  EXPECT_GT((start.X_PT.p() - opened->X_PT_start.p()).norm(), NeutralStart::kAway_mm);
  EXPECT_GT((start.X_PN.p() - opened->the_case.plan.line_P.a).norm(), NeutralStart::kAway_mm);
  EXPECT_EQ(start.depth_mm, 140.0);      // the aorta's view
  EXPECT_GT(start.X_PT.R()(1, 1), 0.8);  // from the front
  const ultrasound::ScanGeometry scan = ultrasound::make_scan_geometry(opened->transducer, start.depth_mm, 65, 64);
  std::vector<ultrasound::LineContact> contact(65);
  ultrasound::find_contact(opened->the_case.patient->skin_distance_mm, scan, start.X_PT, contact);
  const auto touching = std::count_if(contact.begin(), contact.end(), [](const auto& c) { return c.coupling > 0.5F; });
  EXPECT_GT(touching, 52);
}

TEST_F(OpenedCase, SharesUnchangedDataWithTheNextChoice) {
  CaseChoice other = opened->choice;
  other.options.overrides = {"skin.fp=5"};
  ASSERT_FALSE(other == opened->choice);
  const auto next = make_open_case(other, {opened, {}});
  ASSERT_TRUE(next) << next.error().text();
  EXPECT_EQ((*next)->later, opened->later);
  EXPECT_EQ((*next)->flow, opened->flow);
  EXPECT_EQ((*next)->the_case.patient, opened->the_case.patient);
  const auto events = find_curve_events((*next)->predicted, (*next)->the_case.tissues);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_GT(events.front().peak_n, find_curve_events(opened->predicted, opened->the_case.tissues).front().peak_n + 1.0);
}

TEST_F(OpenedCase, PredictsTheForceOfChangedTissues) {
  const auto stiffer = predict_force(opened->the_case, {"skin.fp=5"}, "");
  ASSERT_TRUE(stiffer) << stiffer.error().text();
  const auto events = find_curve_events(*stiffer, opened->the_case.tissues);
  const auto usual = find_curve_events(opened->predicted, opened->the_case.tissues);
  EXPECT_GT(events.front().peak_n, usual.front().peak_n + 1.0);
  const auto wrong = predict_force(opened->the_case, {"skin.colour=5"}, "");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().exit_status, 2);
}

TEST(OpenCase, ReportsInvalidOptionsBeforeOpeningThePatient) {
  CaseChoice choice;
  choice.options.needle = "knitting";
  const auto wrong = make_open_case(choice);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().exit_status, 2);
  choice.options.needle.clear();
  choice.patient_source = "nobody";
  const auto nobody = make_open_case(choice);
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().text().find("abdomen"), std::string::npos);
}

TEST(OpenCase, CachesAnEmbeddedPatient) {
  const TemporaryFolder folder;
  OpenOptions options;
  options.cache_folder = folder / "patients";
  CaseChoice choice;
  choice.patient_source = "layers-liver";
  const auto first = make_open_case(choice, options);
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_TRUE(std::filesystem::is_directory((*first)->server_source));
  const auto second = make_open_case(choice, options);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ((*second)->server_source, (*first)->server_source);
  EXPECT_EQ((*second)->the_case.patient->content_hash, (*first)->the_case.patient->content_hash);
  EXPECT_EQ((*second)->the_case.patient->skin_distance_mm.voxels, (*first)->the_case.patient->skin_distance_mm.voxels);
  EXPECT_LT(((*second)->the_case.plan.line_P.b - (*first)->the_case.plan.line_P.b).norm(), 1e-6);

  // A damaged one is made anew.
  std::filesystem::resize_file(std::filesystem::path((*first)->server_source) / "labels.nrrd", 100);
  const auto third = make_open_case(choice, options);
  ASSERT_TRUE(third) << third.error().text();
  EXPECT_EQ((*third)->the_case.patient->content_hash, (*first)->the_case.patient->content_hash);
  choice.patient_seed = 2;
  const auto other = make_open_case(choice, options);
  ASSERT_TRUE(other) << other.error().text();
  EXPECT_NE((*other)->server_source, (*first)->server_source);
}

TEST(OpenCase, ReturnsNothingWhenCancelled) {
  CaseChoice choice;
  choice.patient_source = "layers-liver";
  auto job = open_case(choice);
  job.cancel();
  while (!job.view().is_done) std::this_thread::yield();
  EXPECT_FALSE(job.take());
}

/// Opens a case in a scope that is cancelled at the report of progress number `n`; false: it was opened before.
bool is_cancelled_at(int n, const std::filesystem::path& cache_folder) {
  CaseChoice choice;
  choice.options.task = "liver-biopsy";
  choice.patient_source = "layers-liver";
  std::stop_source source;
  const CancellationScope scope(source.get_token());
  std::atomic<int> reports = 0;
  const Progress progress = [&](std::string_view, double) {
    if (++reports == n) source.request_stop();
    cancellation_point();
  };
  try {
    const auto opened = make_open_case(choice, OpenOptions{nullptr, cache_folder}, progress);
    EXPECT_TRUE(opened) << opened.error().text();
    return false;
  } catch (const Cancelled&) {
    return true;
  }
}

TEST(CancelledOpening, LeavesNoPartialFilesAtAnyPoint) {
  const TemporaryFolder folder;
  int cancelled = 0;
  for (int n = 1; is_cancelled_at(n, folder / std::to_string(n)); ++n) {
    ++cancelled;
    // What is in the cache is a whole patient: no temporary folder beside it, and it opens.
    const auto entries = list_folder(folder / std::to_string(n));
    if (!entries) continue;
    for (const std::filesystem::path& entry : *entries) {
      if (!std::filesystem::is_directory(entry)) continue;
      const auto patient = io::open_patient({entry.string(), 1});
      EXPECT_TRUE(patient) << entry << ": " << (patient ? "" : patient.error().text());
    }
  }
  EXPECT_GT(cancelled, 5);
}

}  // namespace
}  // namespace trocar::cases
