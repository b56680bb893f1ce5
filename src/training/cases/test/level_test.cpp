// Levels of difficulty and needles, as options of a case.
#include <gtest/gtest.h>

#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "phantom/cases.h"
#include "phantom/phantom.h"

namespace trocar::cases {
namespace {

TEST(Level, RoundTripsThroughTheTaskText) {
  CaseOptions options;
  options.task = "liver-biopsy";
  options.level = "hard";
  const auto made = load_tables(options);
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_EQ(made->task.level, "hard");
  options.level = "3";
  EXPECT_TRUE(load_tables(options)->task == made->task);
  const auto again = tasks::parse_task(made->task_toml, "liver-biopsy", "the session's task", data_dir() / "tasks");
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_TRUE(*again == made->task) << made->task_toml;
  options.level.clear();
  const auto plain = load_tables(options);
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->task_toml.empty());
  EXPECT_LT(made->task.time_limit_s, plain->task.time_limit_s);
  EXPECT_LT(made->task.target_tolerance_mm, plain->task.target_tolerance_mm);
}

TEST(Level, ReplacesTheBreathingOfTheTask) {
  const auto breathing_mm = [](const char* task, const char* level) {
    CaseOptions options;
    options.task = task;
    options.level = level;
    const auto made = load_tables(options);
    return made ? made->task.breathing_mm : -1.0;
  };
  EXPECT_EQ(breathing_mm("liver-biopsy", ""), 0.0);
  EXPECT_EQ(breathing_mm("liver-biopsy", "basic"), 4.0);
  EXPECT_EQ(breathing_mm("liver-biopsy", "hard"), 18.0);
  EXPECT_EQ(breathing_mm("ptcd", "hard"), 0.0) << "a level without it";
  EXPECT_EQ(breathing_mm("lumbar-puncture", ""), 0.0);
  const TemporaryFolder folder;
  const std::string file = folder / "deep.toml";
  ASSERT_TRUE(write_file_atomically(file, "base = \"lumbar-puncture\"\nbreathing_mm = 7.5\n"));
  EXPECT_EQ(breathing_mm(file.c_str(), ""), 7.5);
  ASSERT_TRUE(write_file_atomically(file, "base = \"lumbar-puncture\"\nbreathing_mm = 70\n"));
  EXPECT_EQ(breathing_mm(file.c_str(), ""), -1.0);
}

TEST(CaseTables, RefuseABiopsyGunForAConfirmedTarget) {
  const TemporaryFolder folder;
  const std::string file = folder / "proof.toml";
  ASSERT_TRUE(write_file_atomically(file, "base = \"liver-biopsy\"\nconfirmed_by = \"bile\"\n"));
  CaseOptions options;
  options.task = file;
  const auto made = load_tables(options);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text().find("takes cores"), std::string::npos) << made.error().text();
}

TEST(Level, UnknownLevelListsTheLevels) {
  CaseOptions options;
  options.task = "ptcd";
  options.level = "impossible";
  const auto made = load_tables(options);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text().find("1 basic, 2 usual, 3 hard"), std::string::npos) << made.error().text();
}

TEST(Level, BodyFactorsNameValidParameters) {
  const auto all = tasks::load_tasks(data_dir() / "tasks");
  ASSERT_TRUE(all) << all.error().text();
  for (const tasks::Task& task : *all) {
    EXPECT_GE(task.levels.size(), 3U) << task.name;
    for (const tasks::Tier& level : task.levels) {
      if (level.body.empty()) continue;
      const std::string source = with_body("lumbar-1", level);
      ASSERT_TRUE(source.starts_with("lumbar-1@")) << source;
      phantom::BodyParameters body;
      const Status status = phantom::scale_body(body, std::string_view(source).substr(9));
      EXPECT_TRUE(status) << task.name << ": " << (status ? "" : status.error().text());
    }
  }
}

TEST(NeedleChoice, IsLimitedToThoseOfTheTask) {
  CaseOptions options;
  options.task = "liver-biopsy";
  options.needle = "biopsy-16g";
  EXPECT_TRUE(load_tables(options)) << load_tables(options).error().text();
  options.needle = "quincke-22g";
  const auto made = load_tables(options);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text().find("biopsy-16g"), std::string::npos) << made.error().text();
  EXPECT_EQ(made.error().text().find("tuohy"), std::string::npos) << made.error().text();
}

}  // namespace
}  // namespace trocar::cases
