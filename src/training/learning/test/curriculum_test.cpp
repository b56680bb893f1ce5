#include "learning/curriculum.h"

#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/testing/data_folder.h"

namespace trocar::learning {
namespace {

TEST(Curriculum, HasFiveCasesOfEachTaskByDifficulty) {
  const auto curriculum = load_curriculum(data_dir());
  ASSERT_TRUE(curriculum) << curriculum.error().text();
  for (const char* task : {"ascites-puncture", "lumbar-puncture", "liver-biopsy", "ptcd"}) {
    const Course* course = curriculum->find(task);
    ASSERT_NE(course, nullptr) << task;
    ASSERT_EQ(course->cases.size(), 5u) << task;
    for (int n = 0; n < 5; ++n) EXPECT_EQ(course->cases[static_cast<std::size_t>(n)].difficulty, n + 1);
    EXPECT_FALSE(course->part_weights.empty());
  }
  EXPECT_EQ(curriculum->courses.front().task, curriculum->rules.order.front());
  EXPECT_EQ(curriculum->find("no-such-task"), nullptr);
}

TEST(LearningRules, NameTheFileAndKeyOfAnError) {
  struct Fault {
    const char *from, *to, *named;
  };
  for (const Fault& fault : {Fault{"score = 80.0", "score = 180.0", "mastery.score"},
                             {"score = 80.0", "scores = 80.0", "scores"},
                             {"passes_in_a_row = 3", "passes_in_a_row = 0", "passes_in_a_row"},
                             {"passes_in_a_row = 3", "passes_in_a_row = 2.5", "passes_in_a_row"},
                             {"[1, 3, 7, 16, 35]", "[1, 3, 3]", "intervals_days"},
                             {"[1, 3, 7, 16, 35]", "[1.5]", "intervals_days"},
                             {"[1, 3, 7, 16, 35]", "[]", "intervals_days"},
                             {"[1, 3, 7, 16, 35]", "[0, 3]", "intervals_days"},
                             {"least_attempts = 3", "least_attempts = 6", "least_attempts"},
                             {"lost_points = 10.0", "lost_points = \"a\"", "lost_points"},
                             {"more_help_attempts = 2", "more_help_attempts = 0", "more_help_attempts"},
                             {"first_score = 90.0", "first_score = 101.0", "first_score"},
                             {"exam_score = 80.0", "exam_scores = 80.0", "exam_scores"},
                             {"most_in_a_row = 3", "most_in_a_row = 0", "most_in_a_row"},
                             {"attempts = 10 ", "attempts = 2 ", "plateau"},
                             {"least_slope = 0.25", "least_slope = nan", "least_slope"},
                             {"rest_attempts = 10", "rest_attempts = -1", "rest_attempts"},
                             {"\"ptcd\"]", "\"ptcd\", \"nothing\"]", "nothing"}}) {
    const testing::OwnDataFolder data;
    data.change("learning.toml", fault.from, fault.to);
    const auto curriculum = load_curriculum(data_dir());
    ASSERT_FALSE(curriculum) << fault.to;
    const std::string text = curriculum.error().text();
    EXPECT_NE(text.find("learning.toml"), std::string::npos) << text;
    EXPECT_NE(text.find(fault.named), std::string::npos) << text;
  }
  const testing::OwnDataFolder data;
  data.remove("learning.toml");
  EXPECT_FALSE(load_curriculum(data_dir()));
}

}  // namespace
}  // namespace trocar::learning
