#include <gtest/gtest.h>

#include <fstream>

#include "core/files/output_file.h"
#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

using testing::example_info;
using testing::example_outcome;
using testing::example_sample;

telemetry::TickSample sample_at(std::size_t n) {
  telemetry::TickSample sample = example_sample(n);
  sample.time_s = 0.001 * static_cast<double>(n);
  return sample;
}

const SessionParameters kFirst{0, 0.0, {}, {"force_model=insertion", "coupling.stiffness=1"}, "[skin]\nfp = 2.8\n"};
const SessionParameters kChanged{
    7, 0.007, {"skin.fp=6", "coupling.stiffness=0.5"}, {"force_model=insertion", "coupling.stiffness=0.5"}, "other\n"};
const tasks::Interruption kGap{0.004, 0.009, "the needle's server was away"};

void write_with_changes(const std::filesystem::path& path) {
  auto writer = SessionWriter::create(path, example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < 12; ++n) {
    if (n == 9) {
      ASSERT_TRUE(writer->append(kGap));
    }
    ASSERT_TRUE(writer->append(sample_at(n)));
    if (n == 0) {
      ASSERT_TRUE(writer->append(kFirst));
    }
    if (n == 8) {
      ASSERT_TRUE(writer->append(kChanged)) << "a server may tell it some ticks later";
    }
  }
  ASSERT_TRUE(writer->finish(example_outcome(), {}));
}

TEST(SessionParametersFile, RoundTripsChangesAndInterruptions) {
  const TemporaryFolder folder;
  write_with_changes(folder / "s.trocar");
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->parameters.size(), 2u);
  EXPECT_EQ(session->info.tissue_table_toml, kFirst.tissue_table_toml) << "as in force at the first tick";
  const SessionParameters& changed = session->parameters[1];
  EXPECT_EQ(changed.tick, kChanged.tick);
  EXPECT_EQ(changed.time_s, kChanged.time_s);
  EXPECT_EQ(changed.settings, kChanged.settings);
  EXPECT_EQ(changed.options, kChanged.options);
  EXPECT_EQ(changed.tissue_table_toml, kChanged.tissue_table_toml);
  ASSERT_EQ(session->interruptions.size(), 1u);
  EXPECT_EQ(session->interruptions[0].from_s, kGap.from_s);
  EXPECT_EQ(session->interruptions[0].to_s, kGap.to_s);
  EXPECT_EQ(session->interruptions[0].reason, kGap.reason);
}

/// The fields of a column of the CSV.
std::vector<std::string> column(const std::string& csv, std::size_t index) {
  std::vector<std::string> fields;
  std::istringstream text(csv);
  for (std::string line; std::getline(text, line);) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t n = 0; n <= index; ++n) std::getline(cells, cell, ',');
    fields.push_back(cell);
  }
  return fields;
}

TEST(SessionParametersFile, ShowsThemInTheEventColumnOfCsvAndView) {
  constexpr std::size_t kEvent = 27;
  const TemporaryFolder folder;
  write_with_changes(folder / "s.trocar");
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_TRUE(export_csv(*session, folder / "s.csv"));
  const std::vector<std::string> events = column(*read_file(folder / "s.csv"), kEvent);
  ASSERT_EQ(events.size(), 13u);
  EXPECT_EQ(events[0], "event");
  EXPECT_TRUE(events[8].starts_with("set:skin.fp=6;set:coupling.stiffness=0.5")) << events[8];
  EXPECT_TRUE(events[10].starts_with("interruption:0.005")) << events[10];
  EXPECT_EQ(events[1].find("set:"), std::string::npos) << "nothing was set before the start";

  soci::session database;
  detail::open_database(database, folder / "s.trocar");
  std::vector<std::string> shown(20);
  database << "SELECT event FROM session_rows", soci::into(shown);
  EXPECT_EQ(shown, std::vector<std::string>(events.begin() + 1, events.end()));
}

TEST(SessionParametersFile, OpensSessionsOfOlderPrograms) {
  const TemporaryFolder folder;
  write_with_changes(folder / "s.trocar");
  {
    soci::session database;
    detail::open_database(database, folder / "s.trocar");
    for (const char* statement :
         {"DROP VIEW session_rows", "DROP TABLE parameters", "DROP TABLE interruptions", "DROP TABLE tick_blocks",
          "DROP TABLE checksums", "DELETE FROM info WHERE key IN ('task_toml', 'device_preset')"})
      database << statement;
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 12u);
  EXPECT_TRUE(session->parameters.empty());
  EXPECT_TRUE(session->interruptions.empty());
  EXPECT_EQ(session->info.tissue_table_toml, example_info().tissue_table_toml);
}

TEST(SessionParametersFile, RefusesAChangeBeyondTheTicks) {
  const TemporaryFolder folder;
  write_with_changes(folder / "s.trocar");
  {
    soci::session database;
    detail::open_database(database, folder / "s.trocar");
    database << "UPDATE parameters SET tick = 12 WHERE tick = 7";
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().what.find("changes of parameters"), std::string::npos) << session.error().text();
}

TEST(SessionParametersFile, DetectsMissingChanges) {
  for (const char* statement : {"DROP TABLE parameters", "DELETE FROM parameters WHERE tick = 7",
                                "UPDATE parameters SET settings = '' WHERE tick = 7", "DROP TABLE interruptions"}) {
    const TemporaryFolder folder;
    write_with_changes(folder / "s.trocar");
    {
      soci::session database;
      detail::open_database(database, folder / "s.trocar");
      database << "DROP VIEW session_rows";
      database << statement;
    }
    EXPECT_FALSE(load_session(folder / "s.trocar")) << statement;
  }
}

}  // namespace
}  // namespace trocar::storage
