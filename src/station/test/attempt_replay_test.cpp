#include "station/attempt_replay.h"

#include <gtest/gtest.h>

#include "core/temporary_folder.h"
#include "headless/run_session.h"

namespace trocar {
namespace {

/// The expert's liver biopsy, performed once.
struct Recorded {
  std::shared_ptr<const OpenCase> open;
  std::unique_ptr<TemporaryFolder> folder;
  std::filesystem::path session;
};

const Recorded& recorded() {
  static const Recorded the_one = [] {
    Recorded r;
    r.open = *make_open_case({});
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

TEST(AttemptReplay, NamesWhatHappenedInOrder) {
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
  EXPECT_NE(replay->worst().text.find("mm beside"), std::string::npos) << replay->worst().text;
}

TEST(AttemptReplay, ASessionOfAnotherPatientIsRefused) {
  auto other = std::make_shared<OpenCase>(*recorded().open);
  auto patient = std::make_shared<VirtualPatient>(*other->the_case.patient);
  patient->content_hash = "another";
  other->the_case.patient = patient;
  const auto replay = AttemptReplay::load(recorded().session, other);
  ASSERT_FALSE(replay);
  EXPECT_NE(replay.error().text().find("another patient"), std::string::npos);
}

}  // namespace
}  // namespace trocar
