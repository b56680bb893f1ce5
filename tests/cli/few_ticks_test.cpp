// Sessions that ended before or at their first tick: every command says so, or reports without a number that is none.
#include <gtest/gtest.h>

#include "cli/program.h"
#include "storage/session_file.h"

namespace trocar::cli_test {
namespace {

class FewTicks : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    const std::string whole = folder_ / "whole.session";
    const Outcome ran = trocar("run liver-biopsy --patient layers-liver --operator expert --out '" + whole + "'");
    ASSERT_EQ(ran.exit_status, 0) << ran.err;
    const auto session = storage::load_session(whole);
    ASSERT_TRUE(session) << session.error().text();
    auto writer = storage::SessionWriter::create(short_, session->info);
    ASSERT_TRUE(writer) << writer.error().text();
    for (std::size_t n = 0; n < GetParam(); ++n) ASSERT_TRUE(writer->append(session->samples[n]));
    scoring::Outcome outcome;
    outcome.not_scored = "the needle never touched the skin";
    ASSERT_TRUE(writer->finish(outcome, {}));
  }

  TemporaryFolder folder_;
  std::string short_ = folder_ / "short.session";
};

TEST_P(FewTicks, HaveMetricsOrReasons) {
  const Outcome outcome = trocar("session metrics '" + short_ + "' --json");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const config::Json json = json_of(outcome);
  ASSERT_FALSE(json["metrics"].empty());
  std::size_t values = 0;
  for (const config::Json& metric : json["metrics"]) {
    const bool has_value = metric.contains("value") && metric["value"].is_number();
    values += has_value ? 1 : 0;
    EXPECT_NE(has_value, metric.contains("missing")) << metric.dump();
  }
  EXPECT_EQ(values > 0, GetParam() > 0);
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos);
  EXPECT_EQ(trocar("session metrics '" + short_ + "'").exit_status, 0);
}

TEST_P(FewTicks, HaveAReport) {
  const std::string html = folder_ / "short.html";
  const Outcome outcome = trocar("session report '" + short_ + "' --out '" + html + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const std::string text = read_text(html);
  EXPECT_NE(text.find("the needle never touched the skin"), std::string::npos);
  for (const char* none : {">nan", " nan", ",nan", "(nan", "-nan", "\"nan", ">inf", ",inf", "-inf", "\"inf"})
    EXPECT_EQ(text.find(none), std::string::npos) << none;
}

TEST_P(FewTicks, AreExportedAndReplayedOrRefused) {
  const std::string csv = folder_ / "short.csv";
  EXPECT_EQ(trocar("session export '" + short_ + "' --csv '" + csv + "'").exit_status, 0);
  EXPECT_EQ(line_count(read_text(csv)), static_cast<int>(GetParam()) + 1);
  const std::string again = folder_ / "again.session";
  const Outcome replay = trocar("run --operator 'replay:" + short_ + "' --out '" + again + "' --json");
  if (GetParam() == 0) {
    EXPECT_EQ(replay.exit_status, 1);
    EXPECT_EQ(line_count(replay.err), 1) << replay.err;
    EXPECT_NE(replay.err.find("before its first tick"), std::string::npos) << replay.err;
  } else {
    ASSERT_EQ(replay.exit_status, 0) << replay.err;
    const config::Json json = json_of(replay);
    EXPECT_TRUE(json["score"].is_null());
    EXPECT_EQ(json["not_scored"], "the needle never touched the skin");
    EXPECT_FALSE(json["hints"].empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Count, FewTicks, ::testing::Values(0U, 1U));

}  // namespace
}  // namespace trocar::cli_test
