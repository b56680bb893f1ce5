#include "server/flight_recorder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/files/atomic_file.h"
#include "core/files/temporary_folder.h"

namespace trocar::server {
namespace {

ServoRecord record_at(std::uint64_t tick, telemetry::GateFault fault) {
  ServoRecord record;
  record.tick = tick;
  record.fault = fault;
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
  EXPECT_EQ(
      std::count_if(flight.begin(), flight.end(), [](const auto& r) { return r.fault == telemetry::GateFault::kNone; }),
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

TEST(WriteFlight, WritesARowAPeriodUnderAHeader) {
  const TemporaryFolder folder;
  std::vector<ServoRecord> flight(3, record_at(7, telemetry::GateFault::kDeviceLost));
  flight[0].fault = telemetry::GateFault::kNone;
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

TEST(WriteFlight, KeepsWithinItsBytesButAlwaysTheNewest) {
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

TEST(WriteFlight, SaysThatAFolderCannotBeWritten) {
  EXPECT_FALSE(write_flight("/proc/nowhere", "20260101T000000Z", {record_at(1, telemetry::GateFault::kDeviceLost)}));
}

}  // namespace
}  // namespace trocar::server
