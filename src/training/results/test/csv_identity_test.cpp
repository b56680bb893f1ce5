// Whatever text a database holds comes back from its CSV file.
#include <fmt/format.h>

#include <fstream>

#include "config/csv.h"
#include "core/random.h"
#include "results/attempts_csv.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class HostileTexts {
 public:
  explicit HostileTexts(std::uint64_t seed) : random_(seed) {}

  std::string next() {
    static const std::vector<std::string> kPieces{"=",
                                                  "+",
                                                  "-",
                                                  "@",
                                                  "\t",
                                                  "\r",
                                                  "\n",
                                                  "\r\n",
                                                  "'",
                                                  "\"",
                                                  ";",
                                                  ",",
                                                  " ",
                                                  "a",
                                                  "0",
                                                  "|",
                                                  "ä",
                                                  "針",
                                                  "😀",
                                                  "\xe2\x80\xae",
                                                  "''",
                                                  ";=",
                                                  ",@",
                                                  "\"\";=",
                                                  "=1+1;b",
                                                  "\n=1+1",
                                                  "=cmd|' /C calc'!A0",
                                                  "\xef\xbc\x9d"};
    std::string text;
    for (std::uint64_t n = random_.next() % 12; n > 0; --n) text += kPieces[random_.next() % kPieces.size()];
    return text;
  }

 private:
  Random random_;
};

/// The cells that a program finds which separates by `separators` and knows no quotation inside of a cell.
void expect_no_formula(const std::string& row, std::string_view separators) {
  for (std::size_t begin = 0; begin < row.size();) {
    const std::size_t end = std::min(row.find_first_of(separators, begin), row.size());
    std::string_view cell = std::string_view(row).substr(begin, end - begin);
    cell.remove_prefix(std::min(cell.find_first_not_of(" \""), cell.size()));
    EXPECT_FALSE(!cell.empty() && std::string_view("=+-@").find(cell.front()) != std::string_view::npos)
        << row << " has the cell " << cell;
    begin = end + 1;
  }
}

TEST(CsvText, RoundTripsHostileTextForAnySeparator) {
  HostileTexts texts(11);
  for (int round = 0; round < 5000; ++round) {
    const std::string first = texts.next(), second = texts.next();
    const std::string row = config::csv_row({config::csv_text(first), config::csv_text(second)});
    const auto rows = config::parse_csv(row, "test");
    ASSERT_TRUE(rows) << rows.error().text();
    ASSERT_EQ(rows->size(), 1u);
    ASSERT_EQ(rows->front().fields.size(), 2u) << row;
    EXPECT_EQ(config::plain_text(rows->front().fields[0]), first);
    EXPECT_EQ(config::plain_text(rows->front().fields[1]), second);
    expect_no_formula(row, ",\n\r");
    expect_no_formula(row, ";\n\r");
    expect_no_formula(row, "\t\n\r");
  }
}

TEST(CsvText, ParsesChunksOfAnySize) {
  const std::string text =
      "\xef\xbb\xbf"
      "a,\"b\"\"c\nd\"\r\n\r\n\"\",e\n";
  for (std::size_t size = 1; size < text.size(); ++size) {
    config::CsvReader reader(
        [&, at = std::size_t{0}]() mutable -> Result<std::string> {
          const std::string piece = text.substr(std::min(at, text.size()), size);
          at += size;
          return piece;
        },
        "test");
    config::CsvRow row;
    EXPECT_TRUE(reader.next(row).value());
    EXPECT_EQ(row.fields, (std::vector<std::string>{"a", "b\"c\nd"})) << size;
    EXPECT_TRUE(reader.next(row).value());
    EXPECT_EQ(row.fields, (std::vector<std::string>{"", "e"})) << size;
    EXPECT_FALSE(reader.next(row).value()) << size;
  }
}

TEST(CsvText, RefusesAnEndlessRow) {
  config::CsvReader quotation([]() -> Result<std::string> { return "\"" + std::string(1 << 20, 'x'); }, "file");
  config::CsvRow row;
  EXPECT_FALSE(quotation.next(row));
  config::CsvReader fields([]() -> Result<std::string> { return std::string(1 << 20, ','); }, "file");
  const auto endless = fields.next(row);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().what.find("fields"), std::string::npos);
  const auto nul = config::parse_csv(std::string("a,\"b\0c\"\n", 8), "file");
  ASSERT_FALSE(nul);
  EXPECT_EQ(nul.error().where, "file, line 1, field 2");
}

class CsvIdentity : public ResultsTest {
 protected:
  /// Their rows, from one database through a file into another one and out again.
  void expect_identity() {
    const auto file = folder_ / "attempts.csv";
    const auto written = export_attempts(*repository_, {}, file);
    ASSERT_TRUE(written) << written.error().text();
    auto other = Repository::open({folder_ / "other.sqlite", {}});
    const auto imported = import_attempts(*other, file, kNow);
    ASSERT_TRUE(imported) << imported.error().text();
    EXPECT_EQ(attempts_csv(*other, {}).value(), attempts_csv(*repository_, {}).value());
    const auto before = list_attempts(*repository_, {}), after = list_attempts(*other, {});
    ASSERT_EQ(before->size(), after->size());
    for (std::size_t n = 0; n < before->size(); ++n) {
      const Attempt &a = (*before)[n], &b = (*after)[n];
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.the_case.task, b.the_case.task);
      EXPECT_EQ(a.the_case.patient, b.the_case.patient);
      EXPECT_EQ(a.the_case.patient_hash, b.the_case.patient_hash);
      EXPECT_EQ(a.level, b.level);
      EXPECT_EQ(a.operator_name, b.operator_name);
      EXPECT_EQ(a.station, b.station);
      EXPECT_EQ(a.program_version, b.program_version);
      EXPECT_EQ(find_person(*repository_, a.person_id)->value().name, find_person(*other, b.person_id)->value().name);
    }
  }
};
TROCAR_BOTH_DATABASES(CsvIdentity);

TEST_P(CsvIdentity, HoldsForHostileTexts) {
  HostileTexts texts(23);
  std::vector<Person> people{add("=cmd|' /C calc'!A0;=1", Group::kTrainee, "-1;=2")};
  for (int n = 0; people.size() < 12; ++n) {
    const Group group = n % 2 == 0 ? Group::kExpert : Group::kTrainee;
    const auto person = add_person(*repository_, {texts.next(), group, n % 3 == 0 ? texts.next() : ";=1"}, kNow);
    if (person) people.push_back(*person);  // names have no control characters
  }
  for (std::size_t n = 0; n < 200; ++n) {
    AttemptRecord record = attempt(people[n % people.size()].id, 71.125);
    Attempt& a = record.attempt;
    a.the_case = {"t" + texts.next(), texts.next(), n, texts.next(), {}};
    a.operator_name = texts.next();
    a.station = texts.next();
    a.program_version = texts.next();
    record.measures.push_back({"of;another=version", "a;=1", -5.25});
    put(record);
  }
  expect_identity();
}

TEST_P(CsvIdentity, HoldsForAVeryLongText) {
  AttemptRecord record = attempt(add("Anna").id, 50.0);
  record.attempt.station.assign(1'000'000, ';');
  record.attempt.station += "=1";
  put(record);
  expect_identity();
}

TEST_P(CsvIdentity, RefusesValuesThatCsvCannotHold) {
  const Person anna = add("Anna");
  const auto refused = [&](auto change) {
    AttemptRecord record = attempt(anna.id, 50.0);
    change(record);
    return !record_attempt(*repository_, record, {});
  };
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.attempt.station = std::string("a\0b", 3); }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.attempt.operator_name = "\xff"; }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.attempt.level = "=1+1"; }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.attempt.id = "=1+1"; }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.attempt.the_case.task = ""; }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.parts[0].name = "x of"; }));
  EXPECT_TRUE(refused([](AttemptRecord& r) { r.measures[0].name = ""; }));
  EXPECT_FALSE(refused([](AttemptRecord&) {}));
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 1u);
}

TEST_P(CsvIdentity, StreamedExportHasEveryAttemptOnce) {
  const Person anna = add("Anna"), ben = add("Ben");
  std::vector<AttemptRecord> records;
  for (int n = 0; n < 1203; ++n) {
    records.push_back(attempt(n % 3 == 0 ? ben.id : anna.id, 50.0));
    records.back().trace = {};
  }
  ASSERT_TRUE(record_attempts(*repository_, records));
  const auto rows = config::parse_csv(attempts_csv(*repository_, {}).value(), "test");
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), records.size() + 1);
  for (std::size_t n = 0; n < records.size(); ++n) EXPECT_EQ((*rows)[n + 1].fields[0], records[n].attempt.id);
  EXPECT_EQ(config::parse_csv(attempts_csv(*repository_, {ben.id}).value(), "test")->size(), 401u + 1);
}

/// A deletion while a slow client reads: what was not sent yet is gone.
TEST_P(CsvIdentity, ExportStopsWhenItsPersonIsDeleted) {
  const Person anna = add("Anna");
  put(attempt(anna.id, 50.0));
  AttemptsExport attempts = AttemptsExport::begin(*repository_, {}).value();
  EXPECT_FALSE(attempts.next(*repository_)->empty());
  ASSERT_TRUE(delete_person(*repository_, anna.id));
  EXPECT_EQ(attempts.next(*repository_).value(), "");
}

TEST_P(CsvIdentity, ExportFailsOnAMeasureWithoutAColumn) {
  const Person anna = add("Anna");
  AttemptRecord record = attempt(anna.id, 50.0);
  ASSERT_TRUE(begin_attempt(*repository_, record.attempt));
  put(attempt(anna.id, 60.0));
  AttemptsExport attempts = AttemptsExport::begin(*repository_, {}).value();
  record.measures.push_back({"of_tomorrow", "mm", 5.0});
  put(record);
  EXPECT_FALSE(attempts.next(*repository_)->empty());
  EXPECT_FALSE(attempts.next(*repository_));
}

}  // namespace
}  // namespace trocar::results
