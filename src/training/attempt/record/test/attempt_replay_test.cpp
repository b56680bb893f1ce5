#include "attempt/record/attempt_replay.h"

#include <gtest/gtest.h>

#include "attempt/offline/run_session.h"
#include "cases/testing/cached_case.h"
#include "core/files/folders.h"

namespace trocar::attempt {
namespace {

/// The expert's liver biopsy, performed once.
struct Recorded {
  std::shared_ptr<const cases::OpenCase> open;
  std::unique_ptr<TemporaryFolder> folder;
  std::filesystem::path session;
};

const Recorded& recorded() {
  static const Recorded the_one = [] {
    Recorded r;
    r.open = *testing::open_cached_case();
    r.folder = std::make_unique<TemporaryFolder>();
    r.session = r.folder->path() / "expert.trocar";
    RunOptions options;
    options.session = r.session;
    options.patient_source = "abdomen";
    EXPECT_TRUE(run_session(r.open->the_case, options));
    return r;
  }();
  return the_one;
}

TEST(AttemptReplay, GivesTheTickOfATime) {
  const auto replay = AttemptReplay::load(recorded().session, recorded().open);
  ASSERT_TRUE(replay) << replay.error().text();
  EXPECT_FALSE(replay->was_cut_off());
  EXPECT_GT(replay->outcome().score, 50.0);
  EXPECT_GT(replay->duration_s(), 5.0);
  EXPECT_EQ(replay->at(-1.0).time_s, replay->session().samples.front().time_s);
  EXPECT_EQ(replay->at(1e9).time_s, replay->duration_s());
  EXPECT_NEAR(replay->at(3.0).time_s, 3.0, 0.0011);
  EXPECT_LE(replay->at(3.0).time_s, 3.0);
  EXPECT_EQ(replay->shaft_at(3.0).back(), replay->at(3.0).tip_mm);
}

TEST(AttemptReplay, ListsEventsInOrder) {
  const auto replay = AttemptReplay::load(recorded().session, recorded().open);
  ASSERT_TRUE(replay);
  std::string kinds;
  double last_s = 0.0;
  for (const ReplayMoment& moment : replay->moments()) {
    EXPECT_GE(moment.time_s, last_s);
    last_s = moment.time_s;
    kinds += moment.text + ";";
  }
  EXPECT_NE(kinds.find("through the skin"), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("through the liver capsule"), std::string::npos) << kinds;
  EXPECT_NE(kinds.find("the gun was fired"), std::string::npos) << kinds;
  ASSERT_EQ(replay->shots().size(), 2u);
  EXPECT_GT(replay->shots()[0].core.target_mm, 0.0);
  ASSERT_EQ(replay->outcome().cores.size(), 2u);
  EXPECT_NEAR(replay->shots()[0].core.target_mm, replay->outcome().cores[0].target_mm, 1e-9);
  const double first_s = replay->shots()[0].time_s, second_s = replay->shots()[1].time_s;
  EXPECT_EQ(replay->shot_at(first_s - 0.01), nullptr);
  EXPECT_EQ(replay->shot_at(first_s), &replay->shots()[0]);
  EXPECT_EQ(replay->shot_at(second_s - 0.01), nullptr) << "the gun is loaded again";
  EXPECT_EQ(replay->shot_at(second_s), &replay->shots()[1]);
  EXPECT_FALSE(replay->worst()) << replay->worst()->text;
}

/// The expert's session with its tips on the planned path, but for one in the middle, which is beside it.
storage::Session session_beside_the_path(double beside_mm) {
  auto session = storage::load_session(recorded().session);
  EXPECT_TRUE(session);
  const Segment& plan_P = session->info.plan_P.line_P;
  const Vec3 along_P = plan_P.direction();
  for (telemetry::TickSample& sample : session->samples)
    sample.rest_tip_mm = plan_P.a + (sample.tip_mm - plan_P.a).dot(along_P) * along_P;
  telemetry::TickSample& middle = session->samples[session->samples.size() / 2];
  EXPECT_GT(middle.depth_mm, 1.0);
  middle.rest_tip_mm += beside_mm * along_P.unitOrthogonal();
  return *std::move(session);
}

TEST(AttemptReplay, WorstMomentIsTheLargestPathErrorAboveOneMm) {
  const auto near = AttemptReplay::of(session_beside_the_path(0.9), recorded().open);
  ASSERT_TRUE(near) << near.error().text();
  EXPECT_FALSE(near->worst());
  const auto far = AttemptReplay::of(session_beside_the_path(3.0), recorded().open);
  ASSERT_TRUE(far) << far.error().text();
  ASSERT_TRUE(far->worst());
  EXPECT_EQ(far->worst()->text, "3.0 mm from the planned path");
  EXPECT_EQ(far->worst()->time_s, far->session().samples[far->session().samples.size() / 2].time_s);
}

/// A session of two ticks in which the transducer is moved, and one without.
std::filesystem::path short_session(const TemporaryFolder& folder,
                                    const std::vector<storage::TransducerSample>& moments) {
  const std::filesystem::path path = folder / "short.trocar";
  const auto from = storage::load_session(recorded().session);
  EXPECT_TRUE(from);
  auto writer = storage::SessionWriter::create(path, from->info);
  EXPECT_TRUE(writer);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_TRUE(writer->append(from->samples[n]));
  for (const storage::TransducerSample& moment : moments) EXPECT_TRUE(writer->append(moment));
  return path;
}

TEST(AttemptReplay, MovesTheTransducerBetweenItsRecordedMoments) {
  const TemporaryFolder folder;
  const Pose from = needle_pose({1.0, 2.0, 3.0}, Vec3::UnitY());
  const Mat3 turned = Eigen::AngleAxisd(0.2, Vec3::UnitX()).toRotationMatrix();
  const Pose to(turned * from.R(), from.p() + Vec3(4.0, 0.0, 0.0));
  const Pose later(to.R(), to.p() + Vec3(0.0, 0.0, 50.0));
  const auto replay = AttemptReplay::load(short_session(folder, {{1.0, from, 0.0}, {1.01, to, 2.0}, {3.0, later, 0.0}}),
                                          recorded().open);
  ASSERT_TRUE(replay) << replay.error().text();
  const auto at = [&](double time_s) { return replay->transducer_at(time_s).value(); };
  EXPECT_EQ(at(0.0).p(), from.p());
  EXPECT_NEAR((at(1.005).p() - Vec3(3.0, 2.0, 3.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(Mat3(at(1.005).R() * from.R().transpose())).angle(), 0.1, 1e-9);
  EXPECT_EQ(at(1.01).p(), to.p());
  EXPECT_EQ(at(2.9).p(), to.p());  // its server was away: it does not drift
  EXPECT_EQ(at(3.0).p(), later.p());
  EXPECT_EQ(at(9.0).p(), later.p());
}

TEST(AttemptReplay, HasNoTransducerIfNoneWasRecorded) {
  const TemporaryFolder folder;
  const auto replay = AttemptReplay::load(short_session(folder, {}), recorded().open);
  ASSERT_TRUE(replay) << replay.error().text();
  EXPECT_FALSE(replay->transducer_at(0.5));
}

TEST(AttemptReplay, UnusedNeedleHasNoScoreOrWorstMoment) {
  const TemporaryFolder folder;
  const auto replay = AttemptReplay::load(short_session(folder, {}), recorded().open);  // two ticks in the air
  ASSERT_TRUE(replay) << replay.error().text();
  EXPECT_EQ(replay->outcome().not_scored, "the needle never touched the skin");
  EXPECT_FALSE(replay->worst());
}

TEST(AttemptReplay, SessionInMemoryMatchesASessionFile) {
  auto session = storage::load_session(recorded().session);
  ASSERT_TRUE(session);
  const double score = session->outcome->score;
  const auto replay = AttemptReplay::of(*std::move(session), recorded().open);
  ASSERT_TRUE(replay) << replay.error().text();
  EXPECT_EQ(replay->outcome().score, score);
}

TEST(AttemptReplay, ASessionOfAnotherPatientIsRefused) {
  auto other = std::make_shared<cases::OpenCase>(*recorded().open);
  auto patient = std::make_shared<anatomy::VirtualPatient>(*other->the_case.patient);
  patient->content_hash = "another";
  other->the_case.patient = patient;
  const auto replay = AttemptReplay::load(recorded().session, other);
  ASSERT_FALSE(replay);
  EXPECT_NE(replay.error().text().find("another patient"), std::string::npos);
}

}  // namespace
}  // namespace trocar::attempt
