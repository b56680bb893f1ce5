#include "results/attempts_csv.h"

#include <algorithm>
#include <fstream>

#include "config/csv.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class AttemptsCsv : public ResultsTest {};
TROCAR_BOTH_DATABASES(AttemptsCsv);

TEST(CsvText, RoundTripsAndIsNeverAFormula) {
  for (const std::string text :
       {"plain", "a,b", "say \"a\"", "two\nlines", "=1+1", "-5", "@x", "'apostrophe", "\ttab", ""}) {
    const std::string field = config::csv_text(text);
    const auto rows = config::parse_csv(config::csv_row({"x", field}), "test");
    ASSERT_TRUE(rows) << text;
    EXPECT_EQ(config::plain_text(rows->front().fields[1]), text);
    if (!text.empty()) {
      EXPECT_EQ(std::string_view("=+-@\t").find(rows->front().fields[1].front()), std::string_view::npos) << text;
    }
  }
}

TEST(CsvText, ErrorsNameLineAndField) {
  struct Case {
    std::string text;
    const char* error;
  };
  for (const Case& c : std::vector<Case>{
           {"a,b\r\nc,\"d", "a quotation does not end — file, line 2, field 2"},
           {"\"a\"b", "text after a quotation — file, line 1, field 1"},
           {"a,b\n\nc,d\"e\n", "a quotation mark inside of a field — file, line 3, field 2"},
           {"\"two\nlines\",b\nx\"", "a quotation mark inside of a field — file, line 3, field 1"},
           {"a, \"b\" ,\"c\" d", "text after a quotation — file, line 1, field 3"},
           {std::string("a\0b", 3), "it is no text — file, line 1, field 1"},
       }) {
    const auto rows = config::parse_csv(c.text, "file");
    ASSERT_FALSE(rows) << c.text;
    EXPECT_TRUE(rows.error().text().starts_with(c.error)) << rows.error().text();
  }
  const auto rows = config::parse_csv("\"two\nlines\", \"b\" \n\nc,d\n", "file");
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->at(0).fields[1], "b") << "spaces around a quotation";
  EXPECT_EQ(rows->at(1).line, 4u);
}

TEST_P(AttemptsCsv, RoundTripsIntoAnotherDatabase) {
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

TEST_P(AttemptsCsv, RoundTripsEveryState) {
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

TEST_P(AttemptsCsv, ImportKeepsTheRecordingOfAnInterruptedAttempt) {
  const Person anna = add("Anna");
  AttemptRecord cut = attempt(anna.id, 0.0);
  cut.attempt.state = State::kInterrupted;
  cut.attempt.score.reset();
  cut.parts.clear();
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

TEST_P(AttemptsCsv, ReadsUnscoredAttemptsOfOlderPrograms) {
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

TEST_P(AttemptsCsv, ChangesNothingOnABadRow) {
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
  EXPECT_NE(refused(bad).find("line 3, column state"), std::string::npos) << refused(bad);
  EXPECT_NE(refused(*good + "one,two\r\n").find("line 3"), std::string::npos);
  EXPECT_NE(refused("").find("empty"), std::string::npos);
  EXPECT_NE(refused("a,b\r\n1,2\r\n").find("there is no column \"a\""), std::string::npos);
  EXPECT_NE(refused("person,task\r\n1,2\r\n").find("column \"attempt\" is missing"), std::string::npos);
}

TEST_P(AttemptsCsv, ARowThatContradictsThePersonIsRefused) {
  const Person anna = add("Anna");
  put(attempt(anna.id, 50.0));
  const auto file = folder_ / "attempts.csv";
  ASSERT_TRUE(export_attempts(*repository_, {}, file));
  for (const NewPerson& known :
       {NewPerson{"anna", Group::kExpert, {}, false, {}}, NewPerson{" Anna", Group::kTrainee, {}, true, {}}}) {
    TemporaryFolder own;
    auto other = Repository::open({own / "other.sqlite", {}});
    ASSERT_TRUE(other && add_person(*other, known, kNow));
    const auto imported = import_attempts(*other, file, kNow);
    ASSERT_FALSE(imported);
    EXPECT_NE(imported.error().text().find("in the database, a trainee in this row"), std::string::npos)
        << imported.error().text();
    EXPECT_NE(imported.error().text().find("group"), std::string::npos);
    EXPECT_TRUE(list_attempts(*other, {})->empty());
  }
}

TEST_P(AttemptsCsv, NamesLineAndColumnOfEveryError) {
  const Person anna = add("Anna");
  put(attempt(anna.id, 50.0));
  const auto good = attempts_csv(*repository_, {});
  ASSERT_TRUE(good);
  const auto rows = config::parse_csv(*good, "good");
  ASSERT_TRUE(rows && rows->size() == 2);
  const std::vector<std::string>& names = rows->front().fields;
  const auto import = [&](const std::string& text) {
    const auto file = folder_ / "changed.csv";
    std::ofstream(file) << text;
    auto other = Repository::open({folder_ / "changed.sqlite", {}});
    const auto imported = import_attempts(*other, file, kNow);
    EXPECT_EQ(list_people(*other)->empty(), !imported) << "all or nothing";
    return imported ? std::string("imported") : imported.error().text();
  };
  struct Case {
    const char *column, *value, *error;
  };
  for (const Case& c : std::vector<Case>{
           {"attempt", "", "the attempt has no valid key"},
           {"attempt", "xyz", "the attempt has no valid key"},
           {"person", "", "is empty"},
           {"group", "student", "the group is unknown"},
           {"course", "a\tb", "column course"},
           {"simulated", "yes", "\"yes\" is neither 0 nor 1"},
           {"task", "", "the task is empty"},
           {"seed", "1.5", "\"1.5\" is no whole number"},
           {"seed", "-1", "\"-1\" is no whole number"},
           {"case", "6", "the difficulty is not 1 to 5"},
           {"level", "beginner", "the level is unknown"},
           {"started_utc", "2026-13-01T00:00:00Z", "the time is none"},
           {"started_utc", "yesterday", "the time is none"},
           {"state", "done", "the state is unknown"},
           {"score", "50,5", "\"50,5\" is no number"},
           {"score", "50.0x", "\"50.0x\" is no number"},
           {"score", "3", "the score is 3, its parts add up to"},
           {"score", "nan", "\"nan\" is no number"},
           {"score", "inf", "\"inf\" is no number"},
           {"score", "101", "the score is not 0 to 100"},
           {"score", " 50", "\" 50\" is no number"},
           {"passed", "true", "\"true\" is neither 0 nor 1"},
           {"duration_s", "-1", "the duration is not 0 s to a day"},
           {"duration_s", "1e308", "the duration is not 0 s to a day"},
           {"started_utc", "2026-01-01T23:59:60Z", "the time is none"},
           {"state", "unscored", "only a finished attempt has a score"},
           {"task", "a\xff", "not UTF-8"},
           {"station", "\xc3", "not UTF-8"},
           {"part target", "-1", "the points are not of 30"},
           {"metric path_length (mm)", "-5", "-5 is negative"},
           {"part target", "1e999", "\"1e999\" is no number"},
           {"part target", "99", "the points are not of 30"},
           {"part target of", "", "the points are not of a number"},
           {"metric path_length (mm)", "long", "\"long\" is no number"},
       }) {
    const auto column = std::ranges::find(names, c.column);
    ASSERT_NE(column, names.end()) << c.column;
    std::vector<std::string> row = rows->back().fields;
    row[static_cast<std::size_t>(column - names.begin())] = c.value;
    for (std::string& field : row)
      if (field.find_first_of(",\n") != std::string::npos) field = "\"" + field + "\"";
    const std::string error = import(config::csv_row(names) + config::csv_row(row));
    EXPECT_NE(error.find(c.error), std::string::npos) << c.column << "=" << c.value << ": " << error;
    EXPECT_NE(error.find("changed.csv, line 2, column "), std::string::npos) << error;
  }
  EXPECT_NE(import(*good + good->substr(good->find("\r\n") + 2)).find("the attempt occurs twice"), std::string::npos);
  EXPECT_NE(import("attempt,attempt" + good->substr(good->find(',', 8))).find("occurs twice"), std::string::npos);
  std::string misspelt = *good;
  misspelt.replace(misspelt.find("score"), 5, "scor");
  EXPECT_NE(import(misspelt).find("there is no column \"scor\""), std::string::npos) << import(misspelt);
  std::string without_limit = *good;
  without_limit.replace(without_limit.find("part target of"), 14, "part other");
  EXPECT_NE(import(without_limit).find("\"part other of\" is missing"), std::string::npos) << import(without_limit);
  std::string nameless = *good, twice = *good;
  nameless.replace(nameless.find("metric path_length"), 18, "metric ");
  EXPECT_NE(import(nameless).find("there is no column"), std::string::npos) << import(nameless);
  twice.replace(twice.find("metric duration (s)"), 19, "metric path_length (mm)");
  for (const auto& [from, to] : {std::pair("path_length (mm)", "path_length (cm)"), {"path_length", "path_lenght"}}) {
    std::string changed = *good;
    changed.replace(changed.find(from), std::string_view(from).size(), to);
    EXPECT_NE(import(changed).find("is unknown"), std::string::npos) << import(changed);
  }
  EXPECT_NE(import(twice).find("occurs twice"), std::string::npos) << import(twice);
  EXPECT_EQ(import(*good), "imported");
}

}  // namespace
}  // namespace trocar::results
