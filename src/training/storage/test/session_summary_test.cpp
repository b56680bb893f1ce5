#include <gtest/gtest.h>

#include "core/files/output_file.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

using testing::example_info;
using testing::example_outcome;
using testing::write_example;

TEST(SessionSummary, MatchesTheFullSession) {
  const TemporaryFolder folder;
  write_example(folder / "a.trocar", 700);
  const auto summary = load_summary(folder / "a.trocar");
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_FALSE(summary->is_incomplete());
  EXPECT_EQ(summary->info.task, example_info().task);
  EXPECT_EQ(summary->info.level, "exam");
  EXPECT_EQ(summary->info.patient_seed, example_info().patient_seed);
  EXPECT_EQ(summary->info.started_utc, example_info().started_utc);
  EXPECT_EQ(summary->outcome->score, example_outcome().score);
  ASSERT_EQ(summary->outcome->parts.size(), example_outcome().parts.size());
  EXPECT_EQ(summary->outcome->parts[1].points, 10.0);
}

TEST(SessionSummary, HasNoOutcomeWhenTheProgramWasKilled) {
  const TemporaryFolder folder;
  {
    auto writer = SessionWriter::create(folder / "a.trocar", example_info());
    ASSERT_TRUE(writer) << writer.error().text();
    ASSERT_TRUE(writer->append(testing::example_sample(0)));
  }
  const auto summary = load_summary(folder / "a.trocar");
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_TRUE(summary->is_incomplete());
  EXPECT_EQ(summary->info.task, example_info().task);
}

TEST(SessionSummary, RefusesAChangedLevelAndAChangedScore) {
  const TemporaryFolder folder;
  for (const char* statement :
       {"UPDATE info SET value = 'guided' WHERE key = 'level'",
        "UPDATE outcome SET json = replace(json, '33.3', '99.3')", "DELETE FROM outcome", "DELETE FROM checksums"}) {
    const auto file = folder / "a.trocar";
    write_example(file, 20);
    ASSERT_TRUE(load_summary(file)) << statement;
    testing::change(file, statement);
    const auto summary = load_summary(file);
    ASSERT_FALSE(summary) << statement;
    EXPECT_NE(summary.error().text().find("a.trocar"), std::string::npos) << summary.error().text();
    std::filesystem::remove(file);
  }
}

TEST(SessionSummary, RefusesNonSessionFiles) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "text.trocar", "hello"));
  EXPECT_FALSE(load_summary(folder / "text.trocar"));
  EXPECT_FALSE(load_summary(folder / "missing.trocar"));
  EXPECT_FALSE(load_summary(folder.path()));
}

}  // namespace
}  // namespace trocar::storage
