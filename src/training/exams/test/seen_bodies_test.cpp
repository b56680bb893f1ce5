#include "exams/exam_body.h"
#include "exams/test/exam_fixture.h"

namespace trocar::exams {
namespace {

using namespace std::chrono;

constexpr sys_seconds kBegin = sys_days(year(2026) / 2 / 3) + hours(4) + minutes(5) + seconds(6);  // exam_info()

/// What the result of the exam of exam_info() says about the body, with this history.
config::Json result_with(const std::vector<SeenBody>& history, const storage::SessionInfo& info = exam_info()) {
  const TemporaryFolder folder;
  const auto key = *signing::SigningKey::make();
  const std::filesystem::path session = folder / "a.trocar";
  EXPECT_TRUE(seal_exam(session, record_exam(session, info), key));
  const auto made = sign_exam(session, history, key);
  EXPECT_TRUE(made) << made.error().text();
  return *config::load_json(*made);
}

bool is_known(const std::vector<SeenBody>& history, const storage::SessionInfo& info = exam_info()) {
  return result_with(history, info)["body_was_known"].get<bool>();
}

TEST(KnownBody, DependsOnEarlierAttemptsOfThePerson) {
  const sys_seconds earlier = kBegin - hours(1), later = kBegin + hours(1);
  EXPECT_FALSE(is_known({}));
  EXPECT_TRUE(is_known({{"1", "ada", "biopsy-2", 4711, earlier, {}}}));
  EXPECT_FALSE(is_known({{"1", "ada", "biopsy-2", 4711, later, {}}}));
  EXPECT_FALSE(is_known({{exam_info().attempt_id, "ada", "biopsy-2", 4711, kBegin, {}}})) << "the exam itself";
  EXPECT_FALSE(is_known({{"1", "ada", "biopsy-2", 4712, earlier, {}}})) << "another body";
  EXPECT_FALSE(is_known({{"1", "ada", "biopsy-3", 4711, earlier, {}}})) << "another patient";
  EXPECT_FALSE(is_known({{"1", "bob", "biopsy-2", 4711, earlier, {}}})) << "another person";
}

TEST(KnownBody, DependsOnRecordingOrderNotOnTheClock) {
  const std::string own = exam_info().attempt_id;
  const SeenBody itself{own, "ada", "biopsy-2", 4711, kBegin, 7};
  const sys_seconds earlier = kBegin - hours(1), later = kBegin + hours(1);
  EXPECT_TRUE(is_known({itself, {"1", "ada", "biopsy-2", 4711, later, 6}})) << "the clock was set back before the exam";
  EXPECT_TRUE(is_known({itself, {"1", "ada", "biopsy-2", 4711, earlier, 8}})) << "recorded on another station";
  EXPECT_FALSE(is_known({itself, {"1", "ada", "biopsy-2", 4711, later, 8}}));
  EXPECT_EQ(result_with({itself})["known_by"], "sessions of the station, database of results");
  EXPECT_EQ(result_with({})["known_by"], "sessions of the station");
}

TEST(KnownBody, ReportsAnonymousAttemptsSeparately) {
  const std::vector<SeenBody> unnamed{{"1", "", "biopsy-2", 4711, kBegin - hours(1), {}}};
  const config::Json result = result_with(unnamed);
  EXPECT_EQ(result["body_was_known"], false);
  EXPECT_EQ(result["body_was_seen_unnamed"], true);
  EXPECT_EQ(result_with({})["body_was_seen_unnamed"], false);
  storage::SessionInfo nobody = exam_info();
  nobody.person_id.clear();
  EXPECT_TRUE(is_known(unnamed, nobody)) << "an exam of nobody counts the attempts of all";
  EXPECT_TRUE(is_known({{"1", "bob", "biopsy-2", 4711, kBegin - hours(1), {}}}, nobody));
}

TEST(KnownBody, IncludesThePractisedBodyAndFolders) {
  storage::SessionInfo info = exam_info();
  info.patient_seed = 1;
  EXPECT_TRUE(is_known({}, info));
  info.patient_source = "/cases/one";
  info.patient_seed = 9;
  EXPECT_TRUE(is_known({}, info));
}

TEST(SeenOnStation, UsesSessionTimesNotFileDates) {
  const TemporaryFolder folder;
  record_exam(folder / "a.trocar", exam_info());
  record_exam(folder / "interrupted.session", exam_info(), 1.0, false);
  overwrite(folder / "broken.trocar", "SQLite format 3");
  std::filesystem::last_write_time(folder / "a.trocar", std::filesystem::file_time_type::max());
  const auto seen = seen_on_station(folder.path());
  ASSERT_TRUE(seen) << seen.error().text();
  ASSERT_EQ(seen->attempts.size(), 2u);
  EXPECT_EQ(seen->damaged.size(), 1u);
  for (const SeenBody& attempt : seen->attempts) {
    EXPECT_EQ(attempt.begin, kBegin);
    EXPECT_EQ(attempt.person_id, "ada");
    EXPECT_EQ(attempt.seed, 4711u);
  }
  EXPECT_TRUE(seen_on_station(folder / "none")->attempts.empty());
}

}  // namespace
}  // namespace trocar::exams
