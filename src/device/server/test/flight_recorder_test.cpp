#include "server/flight_recorder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::server {
namespace {

ServoRecord record_at(std::uint64_t tick, telemetry::GateFault fault) {
  ServoRecord record;
  record.tick = tick;
  record.sample.gate_fault = fault;
  return record;
}

TEST(FlightRecorder, GivesTwoSecondsBeforeAFaultOnce) {
  FlightRecorder recorder(1000.0);
  std::vector<std::vector<ServoRecord>> flights;
  for (std::uint64_t tick = 0; tick < 9000; ++tick) {
    auto given =
        recorder.add(record_at(tick, tick < 5000 ? telemetry::GateFault::kNone : telemetry::GateFault::kRunaway));
    if (given) flights.push_back(std::move(*given));
  }
  ASSERT_EQ(flights.size(), 1U);
  const auto& flight = flights.front();
  EXPECT_EQ(flight.size(), 2100U);
  EXPECT_EQ(flight.back().tick, 5100U);
  EXPECT_EQ(std::count_if(flight.begin(), flight.end(),
                          [](const auto& r) { return r.sample.gate_fault == telemetry::GateFault::kNone; }),
            1999);
}

TEST(FlightRecorder, GivesTheNextFaultToo) {
  FlightRecorder recorder(1000.0);
  int flights = 0;
  for (std::uint64_t tick = 0; tick < 9000; ++tick) {
    const bool is_faulty = tick % 3000 > 2000;
    if (recorder.add(record_at(tick, is_faulty ? telemetry::GateFault::kNotFinite : telemetry::GateFault::kNone)))
      ++flights;
  }
  EXPECT_EQ(flights, 3);
}

TEST(WriteFlight, WritesAHeaderAndOneRowPerPeriod) {
  const TemporaryFolder folder;
  std::vector<ServoRecord> flight(3, record_at(7, telemetry::GateFault::kDeviceLost));
  flight[0].sample.gate_fault = telemetry::GateFault::kNone;
  const auto path = write_flight(folder.path(), "20260101T000000Z", flight);
  ASSERT_TRUE(path) << path.error().text();
  EXPECT_NE(path->filename().string().find(to_string(telemetry::GateFault::kDeviceLost)), std::string::npos);
  const auto text = read_file(*path);
  ASSERT_TRUE(text);
  EXPECT_EQ(std::count(text->begin(), text->end(), '\n'), 4);
  const auto commas = [](std::string_view line) { return std::count(line.begin(), line.end(), ','); };
  const std::size_t first_end = text->find('\n');
  const std::size_t second_end = text->find('\n', first_end + 1);
  EXPECT_EQ(commas(std::string_view(*text).substr(0, first_end)),
            commas(std::string_view(*text).substr(first_end, second_end - first_end)));
}

TEST(WriteFlight, KeepsTheNewestFilesOfItsFolderOnly) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "flight-notes.csv", "somebody's own"));
  ASSERT_TRUE(write_file_atomically(folder / "session.csv", "somebody's own"));
  const std::size_t kept = FlightQuota{}.files;
  for (std::size_t i = 0; i < kept + 5; ++i) {
    const std::string utc = fmt::format("20260101T0000{:02}Z", i);
    ASSERT_TRUE(write_flight(folder.path(), utc, {record_at(1, telemetry::GateFault::kDeviceLost)}));
  }
  std::size_t flights = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    flights += entry.path().filename().string().ends_with("device_lost.csv") ? 1 : 0;
  EXPECT_EQ(flights, kept);
  EXPECT_FALSE(std::filesystem::exists(folder / "flight-20260101T000004Z-device_lost.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "flight-20260101T000005Z-device_lost.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "flight-notes.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "session.csv"));
}

TEST(WriteFlight, BoundsTotalBytesButKeepsTheNewest) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> paths;
  for (int i = 0; i < 4; ++i) {
    paths.push_back(folder / fmt::format("flight-20260101T00000{}Z-runaway.csv", i));
    ASSERT_TRUE(write_file_atomically(paths.back(), std::string(1000, 'x')));
  }
  EXPECT_EQ(keep_quota(folder.path(), paths[3], {10, 2500}), 2U);
  EXPECT_TRUE(std::filesystem::exists(paths[2]));
  EXPECT_EQ(keep_quota(folder.path(), paths[3], {10, 10}), 1U);
  EXPECT_TRUE(std::filesystem::exists(paths[3])) << "the newest stays even if it is larger than the quota";
}

TEST(FlightRecorder, FinishReturnsAFaultOfTheLastMoments) {
  FlightRecorder recorder(1000.0);
  EXPECT_FALSE(recorder.finish());
  for (std::uint64_t tick = 0; tick < 50; ++tick) recorder.add(record_at(tick, telemetry::GateFault::kNone));
  EXPECT_FALSE(recorder.finish()) << "no fault";
  for (std::uint64_t tick = 50; tick < 60; ++tick) recorder.add(record_at(tick, telemetry::GateFault::kRunaway));
  const auto flight = recorder.finish();
  ASSERT_TRUE(flight);
  EXPECT_EQ(flight->back().tick, 59u);
  EXPECT_FALSE(recorder.finish()) << "once";
}

TEST(WriteFlight, OverwritesNoFile) {
  const TemporaryFolder folder;
  std::set<std::filesystem::path> paths;
  for (std::uint64_t tick = 0; tick < 8; ++tick) {  // equal faults of one moment
    const auto path =
        write_flight(folder.path(), "20260101T000000.123Z", {record_at(tick, telemetry::GateFault::kRunaway)});
    ASSERT_TRUE(path) << path.error().text();
    EXPECT_TRUE(paths.insert(*path).second) << path->string();
    const auto text = read_file(*path);
    ASSERT_TRUE(text);
    EXPECT_NE(text->find(fmt::format("\n{},", tick)), std::string::npos);
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 8u) << "no reserved name is left over";
  EXPECT_EQ(keep_quota(folder.path(), *paths.begin(), {3, 1 << 20}), 5u) << "names with a number count, too";
}

TEST(FlightTime, HasMilliseconds) {
  using namespace std::chrono;
  const auto at = [](std::int64_t ms) { return flight_time(system_clock::time_point(milliseconds(ms))); };
  EXPECT_EQ(at(0), "19700101T000000.000Z");
  EXPECT_EQ(at(1767225600123), "20260101T000000.123Z");
}

TEST(FlightFolder, IsCheckedAtTheStart) {
  const TemporaryFolder folder;
  EXPECT_TRUE(check_flight_folder(folder.path()));
  EXPECT_TRUE(folder.is_empty()) << "the check leaves nothing";
  EXPECT_TRUE(check_flight_folder(folder / "new")) << "a missing folder is created";
  EXPECT_TRUE(std::filesystem::is_directory(folder / "new"));
  ASSERT_TRUE(write_file_atomically(folder / "file", "not a folder"));
  for (const std::filesystem::path& bad :
       {folder / "file", folder / "file/below", std::filesystem::path("/proc/none")}) {
    const Status checked = check_flight_folder(bad);
    ASSERT_FALSE(checked) << bad;
    EXPECT_NE(checked.error().text().find("--flight-records"), std::string::npos) << checked.error().text();
  }
}

TEST(WriteFlight, FailsForAnUnwritableFolder) {
  EXPECT_FALSE(write_flight("/proc/nowhere", "20260101T000000Z", {record_at(1, telemetry::GateFault::kDeviceLost)}));
}

}  // namespace
}  // namespace trocar::server
