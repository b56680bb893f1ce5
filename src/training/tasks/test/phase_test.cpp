#include "tasks/phases/phase.h"

#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "tasks/task.h"

namespace trocar::tasks {
namespace {

Result<std::vector<Phase>> parse(const std::string& text) {
  auto document = config::parse_toml(text, "task.toml");
  EXPECT_TRUE(document) << text;
  return read_phases(*document);
}
std::string phases_error(const std::string& text) {
  const auto phases = parse(text);
  return phases ? std::string("no error") : phases.error().text();
}
std::string phase(const std::string& name, const std::string& after, const std::string& done) {
  return "[[phases]]\nname = \"" + name + "\"\ntitle = \"t\"\nwhy = \"w\"\nafter = [" + after + "]\n[phases.done]\n" +
         done + "\n";
}

TEST(Phases, ParseWithTheirConditions) {
  const auto phases =
      parse(phase("a", "", "tip_in = \"csf\"\ninserted_mm = 12.5") + phase("b", "\"a\"", "returned = \"csf\""));
  ASSERT_TRUE(phases) << phases.error().text();
  ASSERT_EQ(phases->size(), 2U);
  ASSERT_EQ((*phases)[0].done.size(), 2U);
  EXPECT_EQ((*phases)[0].done[0].kind, ConditionKind::kInserted);
  EXPECT_EQ((*phases)[0].done[0].number, 12.5);
  EXPECT_EQ((*phases)[0].done[1].name, "csf");
  EXPECT_EQ(condition_words((*phases)[0].done[0]), "advance the needle 12 mm into the body");
  EXPECT_EQ(condition_words((*phases)[1].done[0]), "check what comes back: it has to be spinal fluid");
}

TEST(Phases, ErrorsNameTheMistake) {
  EXPECT_NE(phases_error(phase("a", "\"b\"", "fired = true")).find("after \"b\", which does not exist"),
            std::string::npos);
  EXPECT_NE(phases_error(phase("a", "\"c\"", "fired = true") + phase("b", "\"a\"", "outside = true") +
                         phase("c", "\"b\"", "outside = true"))
                .find("waits for itself"),
            std::string::npos);
  EXPECT_NE(phases_error(phase("a", "\"a\"", "fired = true")).find("waits for itself"), std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "fired = true") + phase("a", "", "outside = true")).find("two phases"),
            std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "")).find("has no condition"), std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "fierd = true")).find("did you mean"), std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "fired = false")).find("asks for nothing"), std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "inserted_mm = -3")).find("inserted_mm"), std::string::npos);
  EXPECT_NE(phases_error(phase("a", "", "returned = \"wine\"")).find("no substance"), std::string::npos);
}

TEST(Phases, DocumentedExampleIsAValidTask) {
  const auto task =
      load_task_file(data_dir().parent_path() / "docs" / "examples" / "renal-biopsy.toml", data_dir() / "tasks");
  ASSERT_TRUE(task) << task.error().text();
  EXPECT_EQ(task->organ, "kidney");
  EXPECT_EQ(task->phases.size(), 3U);
}

TEST(Phases, OfShippedTasksRoundTripThroughText) {
  const auto tasks = load_tasks(data_dir() / "tasks");
  ASSERT_TRUE(tasks) << tasks.error().text();
  for (const Task& task : *tasks) {
    EXPECT_GE(task.phases.size(), 4U) << task.name;
    config::TomlWriter writer;
    write_phases(writer, task.phases);
    const auto again = parse(writer.text());
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(*again, task.phases) << task.name;
    double sum = 0.0;
    for (const auto& [part, weight] : task.weights) sum += weight;
    EXPECT_NEAR(sum, 100.0, 1e-9) << task.name;
  }
}

}  // namespace
}  // namespace trocar::tasks
