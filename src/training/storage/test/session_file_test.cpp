#include "storage/session_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/files/output_file.h"
#include "storage/detail/columns.h"
#include "storage/detail/database.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;
using testing::bits_of;
using testing::example_info;
using testing::example_outcome;
using testing::example_sample;

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Writes `ticks` samples; finishes the session.
void write_session(const fs::path& path, std::size_t ticks, const SessionInfo& info = example_info()) {
  auto writer = SessionWriter::create(path, info);
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < ticks; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  std::vector<std::size_t> shots;
  if (ticks > 5) shots.push_back(5);
  const Status status = writer->finish(example_outcome(), shots);
  ASSERT_TRUE(status) << status.error().text();
}

/// The one line a file is refused with.
std::string refusal(const fs::path& path) {
  const auto session = load_session(path);
  return session ? std::string("opened") : session.error().text();
}

TEST(SessionFile, RoundTripsEveryTickBitwise) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 1234);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->samples.size(), 1234u);
  for (std::size_t n = 0; n < 1234; ++n) EXPECT_EQ(bits_of(session->samples[n]), bits_of(example_sample(n))) << n;
}

TEST(SessionFile, HashCoversEveryBitOfEveryTick) {
  const TemporaryFolder folder;
  const auto hash_of = [&](const char* name, std::size_t ticks, std::size_t changed, double value) {
    auto writer = SessionWriter::create(folder / name, example_info());
    EXPECT_EQ(writer->ticks_hash(), "");
    for (std::size_t n = 0; n < ticks; ++n) {
      telemetry::TickSample sample = example_sample(n);
      if (n == changed) sample.device_tau_nmm.z() = value;
      EXPECT_TRUE(writer->append(sample));
    }
    EXPECT_TRUE(writer->finish(example_outcome(), {}));
    const auto session = load_session(folder / name);
    EXPECT_EQ(session->ticks_hash, writer->ticks_hash());
    return session->ticks_hash;
  };
  const double value = 0.125;
  const std::string hash = hash_of("a.trocar", 1234, 700, value);
  EXPECT_EQ(hash.size(), 32u);
  EXPECT_EQ(hash_of("b.trocar", 1234, 700, value), hash);
  EXPECT_NE(hash_of("c.trocar", 1234, 700, std::nextafter(value, 1.0)), hash) << "one bit of one number";
  EXPECT_NE(hash_of("d.trocar", 1233, 700, value), hash) << "one tick less";
}

TEST(SessionFile, RoundTripsTheCase) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 1);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  const SessionInfo expected = example_info();
  const SessionInfo& info = session->info;
  EXPECT_EQ(info.program_version, expected.program_version);
  EXPECT_EQ(info.started_utc, expected.started_utc);
  EXPECT_EQ(info.task, expected.task);
  EXPECT_EQ(info.patient_name, expected.patient_name);
  EXPECT_EQ(info.patient_source, expected.patient_source);
  EXPECT_EQ(info.patient_hash, expected.patient_hash);
  EXPECT_EQ(info.patient_seed, expected.patient_seed);
  EXPECT_EQ(info.operator_name, expected.operator_name);
  EXPECT_EQ(info.force_model, expected.force_model);
  EXPECT_EQ(info.force_version, expected.force_version);
  EXPECT_EQ(info.seed, expected.seed);
  EXPECT_EQ(info.rate_hz, expected.rate_hz);
  EXPECT_EQ(info.level, expected.level);
  EXPECT_EQ(info.needle, expected.needle);
  EXPECT_EQ(info.device, expected.device);
  EXPECT_EQ(info.tissue_table_toml, expected.tissue_table_toml);
  EXPECT_EQ(info.plan_P.name, expected.plan_P.name);
  EXPECT_EQ(info.plan_P.line_P.a, expected.plan_P.line_P.a);
  EXPECT_EQ(info.plan_P.line_P.b, expected.plan_P.line_P.b);
  EXPECT_EQ(info.is_parenchymal, expected.is_parenchymal);
  ASSERT_TRUE(info.plane);
  EXPECT_EQ(info.plane->field_of_view_rad, expected.plane->field_of_view_rad);
  EXPECT_EQ(info.plane->width_mm, expected.plane->width_mm);
  EXPECT_EQ(info.tissue_names, expected.tissue_names);
  EXPECT_EQ(info.layer_names, expected.layer_names);
  EXPECT_EQ(info.label_names, expected.label_names);
}

TEST(SessionFile, RoundTripsTheOutcome) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 10);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_TRUE(session->outcome);
  EXPECT_EQ(session->shots, std::vector<std::size_t>{5});
  const scoring::Outcome expected = example_outcome();
  EXPECT_EQ(session->outcome->score, expected.score);
  EXPECT_TRUE(session->outcome->target_reached);
  EXPECT_EQ(session->outcome->hints, expected.hints);
  EXPECT_EQ(session->outcome->risks_touched, expected.risks_touched);
  ASSERT_EQ(session->outcome->harms.size(), 1U);
  const metrics::HarmEvent &harm = session->outcome->harms[0], &expected_harm = expected.harms[0];
  EXPECT_EQ(harm.label, expected_harm.label);
  EXPECT_EQ(harm.grade, expected_harm.grade);
  EXPECT_EQ(harm.reason, expected_harm.reason);
  EXPECT_EQ(harm.inside_mm, expected_harm.inside_mm);
  EXPECT_EQ(harm.stayed_s, expected_harm.stayed_s);
  EXPECT_TRUE(harm.has_stayed);
  EXPECT_FALSE(harm.is_graze);
  ASSERT_EQ(session->outcome->parts.size(), expected.parts.size());
  EXPECT_FALSE(session->outcome->parts[2].is_judged);
  EXPECT_EQ(session->outcome->parts[0].title, "Distance to the target");
  EXPECT_EQ(session->outcome->parts[0].value, 0.1);
  EXPECT_EQ(session->outcome->parts[0].points, 29.5);
  EXPECT_EQ(session->outcome->parts[0].max_points, 30.0);
  EXPECT_EQ(session->outcome->parts[1].unit, "s");
  ASSERT_EQ(session->outcome->cores.size(), 1u);
  EXPECT_EQ(session->outcome->cores[0].tip_P, expected.cores[0].tip_P);
  EXPECT_EQ(session->outcome->cores[0].axis_P, expected.cores[0].axis_P);
  ASSERT_EQ(session->outcome->cores[0].pieces.size(), 2u);
  EXPECT_EQ(session->outcome->cores[0].pieces[1].label, "lesion_1");
  EXPECT_EQ(session->outcome->cores[0].pieces[1].to_mm, 19.0);
  EXPECT_EQ(session->outcome->cores[0].vessel_mm, 0.7);
  EXPECT_EQ(session->outcome->cores[0].risks_in_throw, expected.cores[0].risks_in_throw);
}

TEST(SessionFile, KeepsNonFiniteNumbers) {
  const TemporaryFolder folder;
  telemetry::TickSample sample = example_sample(0);
  sample.f_prepuncture_n = std::numeric_limits<double>::quiet_NaN();
  sample.f_total_n[1] = std::numeric_limits<double>::infinity();
  sample.f_total_n[2] = -std::numeric_limits<double>::infinity();
  sample.depth_mm = std::numeric_limits<double>::denorm_min();
  sample.f_cutting_n = -0.0;
  scoring::Outcome outcome = example_outcome();
  outcome.score = std::numeric_limits<double>::quiet_NaN();
  {
    auto writer = SessionWriter::create(folder / "s.trocar", example_info());
    ASSERT_TRUE(writer && writer->append(sample) && writer->append(example_sample(1)));
    ASSERT_TRUE(writer->finish(outcome, {}));
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  const telemetry::TickSample& read = session->samples[0];
  EXPECT_TRUE(std::isnan(read.f_prepuncture_n));
  EXPECT_EQ(read.f_total_n[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.f_total_n[2], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.depth_mm, std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(read.f_cutting_n, 0.0);
  EXPECT_EQ(bits_of(session->samples[1]), bits_of(example_sample(1)));
  EXPECT_TRUE(std::isnan(session->outcome->score));
  EXPECT_TRUE(session->shots.empty());
}

TEST(SessionFile, IsASingleFileWhenFinished) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 700);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 1u);
}

TEST(SessionFile, HoldsNoTickWhenNoneWasAppended) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 0);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_TRUE(session->samples.empty());
  EXPECT_TRUE(session->outcome);
}

TEST(SessionFile, AcceptsPathsWithSpacesEqualSignsAndUmlauts) {
  const TemporaryFolder folder;
  for (const char* name : {"two words and more.trocar", "a=b c.trocar", "Übung 'x';.trocar", ":memory:"}) {
    write_session(folder / name, 3);
    EXPECT_EQ(refusal(folder / name), "opened");
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
}

TEST(SessionFile, NeverOverwritesAnExistingFile) {
  const TemporaryFolder folder;
  write_bytes(folder / "mine.txt", "my text");
  const auto writer = SessionWriter::create(folder / "mine.txt", example_info());
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().exit_status, 2);
  EXPECT_EQ(*read_file(folder / "mine.txt"), "my text");
}

TEST(SessionFile, CreatesAMissingFolder) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "new" / "place" / "s.trocar";
  ASSERT_TRUE(SessionWriter::create(path, example_info()));
  EXPECT_TRUE(fs::exists(path));
  write_bytes(folder / "file", "no folder");
  const auto writer = SessionWriter::create(folder.path() / "file" / "s.trocar", example_info());
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().exit_status, 1);
}

TEST(SessionFile, RefusesANewerFormat) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 3);
  {
    soci::session database;
    detail::open_database(database, folder / "s.trocar");
    database << "PRAGMA user_version = 2";
  }
  EXPECT_NE(refusal(folder / "s.trocar").find("has format 2, this program reads up to 1"), std::string::npos);
}

TEST(SessionFile, RefusesAnotherDatabase) {
  const TemporaryFolder folder;
  {
    soci::session database;
    detail::open_database(database, folder / "other.db");
    database << "CREATE TABLE ticks (tick INTEGER)";
  }
  EXPECT_NE(refusal(folder / "other.db").find("is a database, but not a session"), std::string::npos);
}

TEST(SessionFile, RefusesNonSessionFiles) {
  const TemporaryFolder folder;
  write_bytes(folder / "empty", "");
  write_bytes(folder / "short", "SQLite");
  write_bytes(folder / "text", "a text that is long enough to be anything");
  EXPECT_NE(refusal(folder / "gone").find("no such session"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "gone"));
  EXPECT_NE(refusal(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(refusal(folder / "empty").find("is empty"), std::string::npos);
  EXPECT_NE(refusal(folder / "short").find("is not a session"), std::string::npos);
  EXPECT_NE(refusal(folder / "text").find("is not a session"), std::string::npos);
}

TEST(SessionFile, RefusesAFileCutAnywhere) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 200);
  const std::string bytes = *read_file(folder / "s.trocar");
  for (std::size_t keep = 16; keep + 1 < bytes.size(); keep += bytes.size() / 23) {
    write_bytes(folder / "cut.trocar", bytes.substr(0, keep));
    EXPECT_NE(refusal(folder / "cut.trocar"), "opened") << keep << " of " << bytes.size();
  }
}

TEST(SessionFile, SurvivesRandomBytesAnywhere) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 60);
  const std::string bytes = *read_file(folder / "s.trocar");
  Random random(7);
  int refused = 0;
  for (int round = 0; round < 150; ++round) {
    std::string damaged = bytes;
    for (int n = 0; n < 40; ++n)
      damaged[16 + static_cast<std::size_t>(random.next()) % (bytes.size() - 16)] = static_cast<char>(random.next());
    write_bytes(folder / "bad.trocar", damaged);
    if (refusal(folder / "bad.trocar") != "opened") ++refused;
  }
  EXPECT_GT(refused, 50);  // Damage to the payload of a number cannot be seen; damage to the structure must be.
}

TEST(SessionFile, RefusesIdsOutOfRange) {
  const TemporaryFolder folder;
  const char* const kDamages[] = {"UPDATE ticks SET phase = 9 WHERE tick = 1",
                                  "UPDATE ticks SET tissue = -1",
                                  "UPDATE events SET kind = 77",
                                  "UPDATE events SET slot = 4 WHERE slot = 2",
                                  "DELETE FROM ticks WHERE tick = 1",
                                  "UPDATE outcome SET fired_tick = 99",
                                  "UPDATE outcome SET json = '{}'",
                                  "DELETE FROM info WHERE key = 'seed'",
                                  "UPDATE info SET value = 'x' WHERE key = 'rate_hz'"};
  int number = 0;
  for (const char* damage : kDamages) {
    const fs::path path = folder / std::to_string(number++).c_str();
    write_session(path, 10);
    {
      soci::session database;
      detail::open_database(database, path);
      database << damage;
    }
    EXPECT_NE(refusal(path), "opened") << damage;
    EXPECT_EQ(refusal(path).find('\n'), std::string::npos);
  }
}

TEST(SessionFile, OpensOlderSessionsWithoutGateFields) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 10);
  {
    soci::session database;
    detail::open_database(database, folder / "s.trocar");
    for (const char* newer : {"VIEW session_rows", "TABLE checksums", "TABLE tick_blocks"})
      database << std::string("DROP ") + newer;
    for (const char* column : {"device_tau_x_nmm", "device_tau_y_nmm", "device_tau_z_nmm", "gate_mode", "gate_fault",
                               "gate_scale", "coupling_share"})
      database << std::string("ALTER TABLE ticks DROP COLUMN ") + column;
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->samples.size(), 10u);
  EXPECT_EQ(session->samples[7].device_f_n, example_sample(7).device_f_n);
  EXPECT_EQ(session->samples[7].device_tau_nmm, Vec3(Vec3::Zero()));
  EXPECT_EQ(session->samples[7].gate_mode, telemetry::GateMode::kAbsent);
  EXPECT_EQ(session->samples[7].coupling_share, 1.0);
}

TEST(SessionFile, ShowsNamesInItsView) {
  const TemporaryFolder folder;
  write_session(folder / "s.trocar", 10);
  soci::session database;
  detail::open_database(database, folder / "s.trocar");
  std::string tissue;
  std::string phase;
  std::string event;
  std::string gate;
  database << "SELECT tissue, phase, event, gate_mode FROM session_rows LIMIT 1 OFFSET 3", soci::into(tissue),
      soci::into(phase), soci::into(event), soci::into(gate);
  EXPECT_EQ(gate, "on");
  EXPECT_EQ(tissue, "muscle");
  EXPECT_EQ(phase, "retracting");
  EXPECT_EQ(event, "puncture:liver_capsule;enter:liver;limit:torque");
}

}  // namespace
}  // namespace trocar::storage
