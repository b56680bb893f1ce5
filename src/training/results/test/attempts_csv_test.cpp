#include "results/attempts_csv.h"

#include <fstream>

#include "results/csv_text.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class AttemptsCsv : public ResultsTest {};
TROCAR_BOTH_DATABASES(AttemptsCsv);

TEST(CsvText, ComesBackAndIsNoFormula) {
  for (const std::string text :
       {"plain", "a,b", "say \"a\"", "two\nlines", "=1+1", "-5", "@x", "'apostrophe", "\ttab", ""}) {
    const std::string field = csv_text(text);
    const auto rows = parse_csv(csv_row({"x", field}), "test");
    ASSERT_TRUE(rows) << text;
    EXPECT_EQ(plain_text(rows->front()[1]), text);
    if (!text.empty()) {
      EXPECT_EQ(std::string_view("=+-@\t").find(rows->front()[1].front()), std::string_view::npos) << text;
    }
  }
}

TEST(CsvText, BrokenQuotesAreNamedWithTheirRow) {
  const auto open = parse_csv("a,b\r\nc,\"d", "file");
  ASSERT_FALSE(open);
  EXPECT_NE(open.error().text().find("row 2"), std::string::npos);
  EXPECT_FALSE(parse_csv("\"a\"b", "file"));
}

TEST_P(AttemptsCsv, ComeBackIntoAnotherDatabase) {
  const Person anna = add("=cmd|' /C calc'!A0", Group::kTrainee, "Course, 1"), eva = add("Eva", Group::kExpert);
  const AttemptRecord written = attempt(anna.id, 71.125);
  put(written);
  put(attempt(eva.id, 99.0));
  AttemptRecord running = attempt(anna.id, 0.0);
  running.attempt.state = State::kRunning;
  running.attempt.score.reset();
  ASSERT_TRUE(begin_attempt(*repository_, running.attempt));
  const auto file = folder_ / "attempts.csv";
  ASSERT_TRUE(export_attempts(*repository_, {}, file));

  auto other = Repository::open({folder_ / "other.sqlite", {}});
  ASSERT_TRUE(other);
  auto imported = import_attempts(*other, file, kNow);
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->added, 3);
  EXPECT_EQ(imported->people, 2);
  const auto read = load_attempt(*other, written.attempt.id);
  ASSERT_TRUE(read && *read) << read.error().text();
  EXPECT_EQ((*read)->attempt.score, 71.125);
  EXPECT_EQ((*read)->attempt.started, kNow);
  EXPECT_EQ((*read)->attempt.the_case.difficulty, 1);
  ASSERT_EQ((*read)->parts.size(), 2u);
  EXPECT_EQ((*read)->parts[0].points, written.parts[0].points);
  EXPECT_EQ((*read)->parts[0].max_points, 30.0);
  ASSERT_EQ((*read)->measures.size(), 2u);
  EXPECT_EQ(metric_samples(*other, "liver-biopsy", "path_length")->front().value, 171.125);
  const auto person = get_person_named(*other, anna.name);
  ASSERT_TRUE(person);
  EXPECT_EQ(person->course, "Course, 1");
  EXPECT_EQ(get_person_named(*other, "Eva")->group, Group::kExpert);
  imported = import_attempts(*other, file, kNow);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->present, 3);
  EXPECT_EQ(list_attempts(*other, {})->size(), 3u);
  const auto again = folder_ / "again.csv";
  ASSERT_TRUE(export_attempts(*other, {}, again));
}

TEST_P(AttemptsCsv, OfEveryStateComeBackUnchanged) {
  const Person anna = add("Anna");
  for (const State state :
       {State::kInterrupted, State::kUnscored, State::kNeverBegan, State::kFinished, State::kRunning}) {
    AttemptRecord record = attempt(anna.id, 71.125);
    record.attempt.state = state;
    record.hints.clear();
    for (Part& part : record.parts) part.value = "3.1 mm";
    if (state != State::kFinished) {
      record.attempt.score.reset();
      record.attempt.is_passed = false;
    }
    if (state == State::kRunning) {
      ASSERT_TRUE(begin_attempt(*repository_, record.attempt));
    } else {
      put(record, "recording");
    }
  }
  const auto file = folder_ / "attempts.csv";
  const std::string written = attempts_csv(*repository_, {}).value();
  ASSERT_TRUE(export_attempts(*repository_, {}, file));
  auto other = Repository::open({folder_ / "other.sqlite", {}});
  ASSERT_TRUE(other);
  const auto imported = import_attempts(*other, file, kNow);
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->added, 5);
  EXPECT_EQ(imported->counts.lost, 1);
  EXPECT_EQ(imported->counts.unscored, 1);
  EXPECT_EQ(attempts_csv(*other, {}).value(), written);
}

TEST_P(AttemptsCsv, ReadOverAnInterruptedAttemptKeepItsRecording) {
  const Person anna = add("Anna");
  AttemptRecord cut = attempt(anna.id, 0.0);
  cut.attempt.state = State::kInterrupted;
  cut.attempt.score.reset();
  put(cut, "recording");
  const auto same = folder_ / "same.csv", ended = folder_ / "ended.csv";
  ASSERT_TRUE(export_attempts(*repository_, {}, same));
  std::string text = attempts_csv(*repository_, {}).value();
  auto imported = import_attempts(*repository_, same, kNow);
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->present, 1);
  EXPECT_EQ(**load_recording(*repository_, cut.attempt.id), "recording");
  EXPECT_EQ(load_attempt(*repository_, cut.attempt.id)->value().trace.time_s.size(), 2u);
  // Another station knows how it ended.
  text.replace(text.find("interrupted,,"), 13, "finished,64,");
  std::ofstream(ended) << text;
  imported = import_attempts(*repository_, ended, kNow);
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->added, 1);
  EXPECT_EQ(find_attempt(*repository_, cut.attempt.id)->value().score, 64.0);
  EXPECT_EQ(**load_recording(*repository_, cut.attempt.id), "recording");
  imported = import_attempts(*repository_, same, kNow);
  EXPECT_EQ(imported->present, 1) << "what is known is not forgotten";
  EXPECT_EQ(find_attempt(*repository_, cut.attempt.id)->value().score, 64.0);
}

TEST_P(AttemptsCsv, OfAnOlderProgramSayFinishedWithoutAScore) {
  const Person anna = add("Anna");
  AttemptRecord record = attempt(anna.id, 50.0);
  record.measures = {{"skin_punctures", "1", 1.0}};
  put(record);
  std::string text = attempts_csv(*repository_, {}).value();
  text.replace(text.find("finished,50,"), 12, "finished,,");
  const auto file = folder_ / "old.csv";
  std::ofstream(file) << text;
  auto other = Repository::open({folder_ / "other.sqlite", {}});
  ASSERT_TRUE(import_attempts(*other, file, kNow));
  EXPECT_EQ(list_attempts(*other, {})->front().state, State::kUnscored);
  EXPECT_FALSE(list_attempts(*other, {})->front().is_passed);
}

TEST_P(AttemptsCsv, WithABadRowChangeNothing) {
  const Person anna = add("Anna");
  put(attempt(anna.id, 50.0));
  const auto good = attempts_csv(*repository_, {});
  ASSERT_TRUE(good);
  const auto refused = [&](const std::string& text) {
    const auto file = folder_ / "bad.csv";
    std::ofstream(file) << text;
    auto other = Repository::open({folder_ / "other.sqlite", {}});
    const auto imported = import_attempts(*other, file, kNow);
    EXPECT_TRUE(list_people(*other)->empty());
    return imported ? std::string("imported") : imported.error().text();
  };
  const std::size_t row = good->find("\r\n") + 2;
  std::string bad = *good + good->substr(row);
  bad.replace(bad.rfind("finished"), 8, "whatever");
  EXPECT_NE(refused(bad).find("row 3, column state"), std::string::npos) << refused(bad);
  EXPECT_NE(refused(*good + "one,two\r\n").find("row 3"), std::string::npos);
  EXPECT_NE(refused("").find("empty"), std::string::npos);
  EXPECT_NE(refused("a,b\r\n1,2\r\n").find("column \"attempt\" is missing"), std::string::npos);
}

}  // namespace
}  // namespace trocar::results
