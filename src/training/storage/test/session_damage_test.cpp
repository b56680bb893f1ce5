#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "core/files/output_file.h"
#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;
using testing::bits_of;
using testing::example_info;
using testing::example_outcome;
using testing::example_sample;
using testing::write_example;

void change_all(const fs::path& path, const std::vector<std::string>& statements) {
  soci::session database;
  detail::open_database(database, path);
  for (const std::string& statement : statements) database << statement;
}

/// What the session says of itself, as it was written.
void expect_same_case(const Session& session) {
  EXPECT_EQ(session.info.tissue_names, example_info().tissue_names);
  EXPECT_EQ(session.info.layer_names, example_info().layer_names);
  EXPECT_EQ(session.info.patient_name, example_info().patient_name);
  EXPECT_EQ(session.info.tissue_table_toml, example_info().tissue_table_toml);
  EXPECT_EQ(session.info.plan_P.line_P.b, example_info().plan_P.line_P.b);
  ASSERT_TRUE(session.outcome);
  EXPECT_EQ(session.outcome->score, example_outcome().score);
  EXPECT_EQ(session.outcome->hints, example_outcome().hints);
  EXPECT_EQ(session.shots, std::vector<std::size_t>{5});
  if (!session.has_checksums) return;
  ASSERT_EQ(session.parameters.size(), 1u);
  EXPECT_EQ(session.parameters[0].settings, std::vector<std::string>{"skin.fp=6"});
}

/// Every sample is the one of its tick; ticks of the damaged ranges alone are missing.
void expect_right_samples(const Session& session, std::size_t ticks) {
  std::size_t tick = 0;
  std::size_t sample = 0;
  const auto expect_until = [&](std::size_t end) {
    for (; tick < end && sample < session.samples.size(); ++tick, ++sample)
      ASSERT_EQ(bits_of(session.samples[sample]), bits_of(example_sample(tick))) << "tick " << tick;
    ASSERT_EQ(tick, end);
  };
  bool is_list_whole = true;
  for (const SessionDamage& damage : session.damage) {
    if (damage.ticks == 0) {
      is_list_whole = is_list_whole && damage.part.find("tick_blocks") == std::string::npos;
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_until(damage.first_tick));
    EXPECT_EQ(damage.sample, sample);
    tick += damage.ticks;
  }
  // Without the list, how many ticks there were at the end is not known; its damage is named.
  ASSERT_NO_FATAL_FAILURE(expect_until(is_list_whole ? ticks : tick + session.samples.size() - sample));
  EXPECT_EQ(sample, session.samples.size());
}

struct FlipCounts {
  std::size_t whole = 0, partly = 0, refused = 0;
};

/// Flips bits in copies of one session: what is read is right, or is named as damaged.
FlipCounts flip_bits(std::size_t files, std::size_t flips, std::uint64_t seed) {
  constexpr std::size_t kTicks = 2600;
  const TemporaryFolder folder;
  write_example(folder / "whole", kTicks);
  const std::string whole = read_file(folder / "whole").value();
  Random random(seed);
  FlipCounts counts;
  for (std::size_t n = 0; n < files; ++n) {
    std::string bytes = whole;
    for (std::size_t flip = 0; flip < flips; ++flip) {
      const auto place = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(bytes.size())));
      bytes[place] = static_cast<char>(bytes[place] ^ (1 << static_cast<int>(random.uniform(0.0, 8.0))));
    }
    const fs::path path = folder / "flipped";
    std::ofstream(path, std::ios::binary) << bytes;
    const Result<Session> session = salvage_session(path);
    EXPECT_EQ(load_session(path).has_value(), session && session->damage.empty());
    if (!session) {
      ++counts.refused;
      continue;
    }
    ++(session->damage.empty() ? counts.whole : counts.partly);
    expect_right_samples(*session, kTicks);
    if (session->damage.empty()) expect_same_case(*session);
    if (::testing::Test::HasFatalFailure()) {
      ADD_FAILURE() << "file " << n << " of seed " << seed;
      break;
    }
  }
  return counts;
}

TEST(SessionDamage, DetectsFlippedBitsUnlessHarmless) {
  const FlipCounts one = flip_bits(24, 1, 1);
  EXPECT_GT(one.partly, 10u);
  const FlipCounts many = flip_bits(12, 40, 2);
  EXPECT_EQ(many.whole, 0u);
}

// 240 files each; run by hand with --gtest_also_run_disabled_tests, it prints the counts.
TEST(SessionDamage, DISABLED_FlippedBitsAtLength) {
  for (const std::size_t flips : {1u, 4u, 40u}) {
    const FlipCounts counts = flip_bits(240, flips, 100 + flips);
    std::cout << flips << " flipped bits in each of 240 files: " << counts.whole << " read whole and right, "
              << counts.partly << " in part with the damage named, " << counts.refused << " refused\n";
  }
}

TEST(SessionDamage, NamesTheDamagedBlockAndReturnsTheRest) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  write_example(path, 2600);
  change_all(path, {"UPDATE ticks SET depth_mm = depth_mm + 1 WHERE tick = 700",
                    "DELETE FROM events WHERE tick = (SELECT min(tick) FROM events WHERE tick > 2000)"});
  const auto session = salvage_session(path);
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->damage.size(), 2u);
  EXPECT_EQ(session->damage[0].part, "ticks 500 to 999");
  EXPECT_EQ(session->damage[1].part, "ticks 2000 to 2499");
  EXPECT_EQ(session->samples.size(), 1600u);
  expect_right_samples(*session, 2600);
  expect_same_case(*session);
  const auto strict = load_session(path);
  ASSERT_FALSE(strict);
  EXPECT_NE(strict.error().text().find("the session is damaged: ticks 500 to 999, ticks 2000 to 2499"),
            std::string::npos)
      << strict.error().text();
}

TEST(SessionDamage, FindsTheFiredTickBehindAGap) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  {
    auto writer = SessionWriter::create(path, example_info());
    ASSERT_TRUE(writer);
    for (std::size_t n = 0; n < 1800; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
    ASSERT_TRUE(writer->finish(example_outcome(), std::vector<std::size_t>{1700}));
  }
  change_all(path, {"DELETE FROM ticks WHERE tick = 3"});
  const auto session = salvage_session(path);
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->shots.size(), 1u);
  EXPECT_EQ(bits_of(session->samples[session->shots.front()]), bits_of(example_sample(1700)));
  change_all(path, {"DELETE FROM ticks WHERE tick = 1600"});
  EXPECT_TRUE(salvage_session(path)->shots.empty());
}

TEST(SessionDamage, NamesOtherParts) {
  const std::map<std::string, std::string> parts{
      {"UPDATE info SET value = 'novice' WHERE key = 'operator'", "facts of the case"},
      {"DELETE FROM info WHERE key = 'task'", "facts of the case"},
      {"UPDATE tissues SET name = 'bone' WHERE id = 1", "names of tissues"},
      {"UPDATE transducer SET contact_n = 7 WHERE time_s = 0", "poses of the transducer"},
      {"UPDATE parameters SET settings = 'skin.fp=2.8'", "changes of parameters"},
      {"DROP TABLE parameters", "changes of parameters"},
      {"INSERT INTO interruptions (tick, from_s, to_s, reason) VALUES (5, 1, 2, 'x')", "interruptions"},
      {"UPDATE outcome SET score = 99", "outcome"},
      {"DELETE FROM outcome", "outcome"},
      {"DELETE FROM tick_blocks WHERE first_tick = 500", "tick_blocks"},
      {"DROP TABLE tick_blocks", "tick_blocks"},
      {"DROP TABLE checksums", "facts of the case"}};
  for (const auto& [statement, part] : parts) {
    const TemporaryFolder folder;
    const fs::path path = folder / "s.trocar";
    write_example(path, 1200);
    change_all(path, {statement});
    const auto session = load_session(path);
    ASSERT_FALSE(session) << statement;
    EXPECT_NE(session.error().text().find(part), std::string::npos) << statement << ": " << session.error().text();
  }
}

TEST(SessionDamage, OpensOlderSessionsWithoutChecksums) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  write_example(path, 1200);
  EXPECT_TRUE(load_session(path)->has_checksums);
  change_all(path, {"DROP TABLE tick_blocks", "DROP TABLE checksums"});
  const auto session = load_session(path);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_FALSE(session->has_checksums);
  EXPECT_EQ(session->samples.size(), 1200u);
  expect_same_case(*session);
}

TEST(SessionDamage, DefaultsToTheFirstForceVersion) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  write_example(path, 3);
  EXPECT_EQ(load_session(path)->info.force_version, 7);
  change_all(path, {"DROP TABLE tick_blocks", "DROP TABLE checksums", "DELETE FROM info WHERE key = 'force_version'"});
  const auto session = load_session(path);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->info.force_version, 1);
  for (const char* bad : {"", "0", "-1", "two", "2.5", "99999999999"}) {
    change_all(path, {"INSERT OR REPLACE INTO info (key, value) VALUES ('force_version', '" + std::string(bad) + "')"});
    EXPECT_FALSE(load_session(path)) << bad;
  }
}

TEST(SessionDamage, RefusesTablesWithGeneratedColumns) {
  const std::string endless = "WITH RECURSIVE c(x) AS (SELECT 0 UNION ALL SELECT x + 1 FROM c) ";
  const std::vector<std::vector<std::string>> hostile{
      {"DROP TABLE ticks", "CREATE VIEW ticks AS " + endless + "SELECT x AS tick FROM c"},
      {"DROP TABLE outcome",
       "CREATE VIEW outcome AS " + endless + "SELECT x AS score, x AS fired_tick, 'x' AS json FROM c"},
      {"DROP TABLE info", "CREATE VIEW info AS " + endless + "SELECT x AS key, x AS value FROM c"},
      {"DROP TABLE transducer", "CREATE VIEW transducer AS " + endless + "SELECT x AS time_s FROM c"},
      {"DROP TABLE tissues",
       "CREATE TABLE tissues (id INTEGER PRIMARY KEY, name TEXT AS (printf('%.*c', 100000000, 'x')))",
       "INSERT INTO tissues (id) VALUES (0), (1), (2)"}};
  for (const auto& statements : hostile) {
    const TemporaryFolder folder;
    const fs::path path = folder / "s.trocar";
    write_example(path, 600);
    change_all(path, statements);
    const auto session = load_session(path);
    ASSERT_FALSE(session) << statements.back();
    EXPECT_TRUE(session.error().text().find("is not a table") != std::string::npos ||
                session.error().text().find("computed columns") != std::string::npos)
        << session.error().text();
  }
}

TEST(SessionDamage, RefusesLongTextsWithoutReading) {
  for (const char* statement : {"UPDATE info SET value = printf('%.*c', 30000000, 'x') WHERE key = 'tissue_table_toml'",
                                "INSERT INTO info SELECT 'k' || value, printf('%.*c', 3000000, 'x') FROM (SELECT tick "
                                "AS value FROM ticks LIMIT 9)",
                                "UPDATE labels SET name = printf('%.*c', 100000, 'x') WHERE id = 7"}) {
    const TemporaryFolder folder;
    const fs::path path = folder / "s.trocar";
    write_example(path, 600);
    change_all(path, {statement});
    const auto session = load_session(path);
    ASSERT_FALSE(session) << statement;
    EXPECT_NE(session.error().text().find("facts of the case"), std::string::npos) << session.error().text();
    const auto rest = salvage_session(path);
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->samples.size(), 600u);
  }
}

TEST(SessionDamage, BoundsTheWorkOfAQuery) {
  const TemporaryFolder folder;
  write_example(folder / "s.trocar", 600);
  detail::GuardedDatabase database(folder / "s.trocar");
  const auto count_endlessly = [&] {
    long long rows = 0;
    database.session() << "WITH RECURSIVE c(x) AS (SELECT 0 UNION ALL SELECT x + 1 FROM c) SELECT count(*) FROM c",
        soci::into(rows);
  };
  EXPECT_ANY_THROW(count_endlessly());
  EXPECT_TRUE(database.is_exhausted());
}

TEST(SessionDamage, NeverModifiesTheFile) {
  const TemporaryFolder folder;
  write_example(folder / "s.trocar", 600);
  detail::GuardedDatabase database(folder / "s.trocar");
  EXPECT_ANY_THROW(database.session() << "DELETE FROM ticks");
  EXPECT_ANY_THROW(database.session() << "SELECT * FROM session_rows");
}

TEST(SessionDamage, TheCsvMarksGapsAndIncompleteSessions) {
  const TemporaryFolder folder;
  const fs::path path = folder / "s.trocar";
  {
    auto writer = SessionWriter::create(path, example_info());
    ASSERT_TRUE(writer);
    for (std::size_t n = 0; n < 1600; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  }
  change_all(path, {"DELETE FROM ticks WHERE tick IN (10, 1510)"});
  const auto session = salvage_session(path);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_TRUE(session->is_incomplete);
  ASSERT_TRUE(export_csv(*session, folder / "s.csv"));
  const std::string csv = read_file(folder / "s.csv").value();
  std::vector<std::string> rows;
  for (std::size_t begin = 0; begin < csv.size();) {
    const std::size_t end = csv.find('\n', begin);
    rows.push_back(csv.substr(begin, end - begin));
    begin = end + 1;
  }
  ASSERT_EQ(rows.size(), 1 + 1000u);
  EXPECT_NE(rows[1].find(",damaged:0-499,"), std::string::npos) << rows[1];
  EXPECT_NE(rows.back().find("damaged:1500-1599;incomplete,"), std::string::npos) << rows.back();
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(),
                          [](const std::string& row) {
                            return row.find("damaged") != std::string::npos ||
                                   row.find("incomplete") != std::string::npos;
                          }),
            2);
}

}  // namespace
}  // namespace trocar::storage
