#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <string>
#include <vector>

#include "core/files/folders.h"
#include "core/random.h"
#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "telemetry/tick_fields.h"

namespace trocar::testing {

inline storage::SessionInfo example_info() {
  storage::SessionInfo info;
  info.program_version = "0.1.0";
  info.force_version = 7;
  info.started_utc = "2026-01-02T03:04:05Z";
  info.task = "liver-biopsy";
  info.patient_name = "Näme with 'quotes' & <signs>";
  info.patient_source = "phantom";
  info.patient_hash = "00112233445566778899aabbccddeeff";
  info.patient_seed = 0xffffffffffffffffULL;
  info.operator_name = "constant-velocity:10";
  info.force_model = "insertion";
  info.seed = 0x8000000000000001ULL;
  info.rate_hz = 1000.0;
  info.level = "exam";
  info.needle = "biopsy-18g";
  info.device = "virtual";
  info.tissue_table_toml = "[tissues]\nliver = 1\n";
  info.plan_P = {"expert", {{1.0 / 3.0, -2.5, 1e-300}, {4, 5, 6}}};
  info.is_parenchymal = true;
  info.tissue_names = {"air", "skin", "adipose", "muscle", "liver"};
  info.layer_names = {"skin", "muscle", "liver_capsule"};
  info.label_names.resize(256);
  info.label_names[7] = "liver";
  info.plane =
      metrics::ImagePlane{.depth_mm = 155.5, .radius_mm = 61.0, .field_of_view_rad = 1.0 / 3.0, .width_mm = 60.2};
  return info;
}

/// Tick number n of a made-up attempt: every field has its own value, none is a round number.
inline telemetry::TickSample example_sample(std::size_t n) {
  Random random(n + 1);
  telemetry::TickSample s;
  telemetry::for_each_tick_field([&](const auto& field) {
    telemetry::for_each_column(s, field, [&](const char*, auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      if constexpr (std::is_same_v<Value, double>)
        value = random.uniform(-100.0, 100.0);
      else if constexpr (std::is_enum_v<Value>)
        value = static_cast<Value>(n % (static_cast<std::size_t>(last_of(value)) + 1));
    });
  });
  s.time_s = 0.001 * static_cast<double>(n);
  s.axis.normalize();
  s.rest_axis.normalize();
  s.tissue = static_cast<std::uint8_t>(n % 5);
  if (n % 50 == 3) s.events[0] = {telemetry::EventKind::kPuncture, 2};
  if (n % 100 == 3) s.events[1] = {telemetry::EventKind::kEnter, 7};
  if (n % 200 == 3)
    s.events[2] = {telemetry::EventKind::kLimit, static_cast<std::uint8_t>(telemetry::LimitReason::kTorqueClamped)};
  s.limited = n % 7 == 0;
  return s;
}

inline scoring::Outcome example_outcome() {
  scoring::Outcome outcome;
  outcome.score = 100.0 / 3.0;
  outcome.target_reached = true;
  outcome.parts = {{"target", "Distance to the target", 0.1, "mm", 29.5, 30.0},
                   {"time", "Time", 12.25, "s", 10, 10},
                   {"bevel", "Bevel", 0.0, "", 0, 5, false}};
  outcome.hints = {{"Hold the needle nearer to 30°", 1.25}, {"\"quoted\" \\ \n second line", {}}};
  scoring::BiopsyCore core;
  core.tip_P = {0.1, 0.2, 0.3};
  core.axis_P = {0, 0, -1};
  core.pieces = {{"liver", "liver", 0.0, 7.1}, {"lesion_1", "liver_lesion", 7.1, 19.0}};
  core.target_mm = 11.9;
  core.organ_mm = 7.1;
  core.vessel_mm = 0.7;
  core.other_mm = 0.3;
  core.risks_in_throw = {"gallbladder"};
  outcome.cores = {core};
  outcome.risks_touched = {"rib_right_9"};
  metrics::HarmEvent harm;
  harm.label = "rib_right_9";
  harm.grade = tasks::Harm::kCritical;
  harm.has_stayed = true;
  harm.inside_mm = 1.0 / 3.0;
  harm.stayed_s = 12.5;
  harm.reason = "it is a \"test\"";
  outcome.harms = {harm};
  return outcome;
}

/// Writes a session of `ticks` samples, finished, with the transducer at every tenth; the gun was fired at sample 5.
inline void write_example(const std::filesystem::path& path, std::size_t ticks) {
  auto writer = storage::SessionWriter::create(path, example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < ticks; ++n) {
    const telemetry::TickSample sample = example_sample(n);
    ASSERT_TRUE(writer->append(sample));
    if (n == 3) {
      ASSERT_TRUE(writer->append(storage::SessionParameters{3, sample.time_s, {"skin.fp=6"}, {}, "[tissues]\n"}));
    }
    if (n % 10 != 0) continue;
    ASSERT_TRUE(writer->append(storage::TransducerSample{sample.time_s, Pose(), 0.5}));
  }
  std::vector<std::size_t> shots;
  if (ticks > 5) shots.push_back(5);
  const Status status = writer->finish(example_outcome(), shots);
  ASSERT_TRUE(status) << status.error().text();
}

/// Runs a statement on the database of a session.
inline void change(const std::filesystem::path& path, const std::string& statement) {
  soci::session database;
  storage::detail::open_database(database, path);
  database << statement;
}

/// All fields of a sample, bit by bit.
inline std::vector<std::uint64_t> bits_of(const telemetry::TickSample& sample) {
  std::vector<std::uint64_t> bits;
  telemetry::for_each_tick_field([&](const auto& field) {
    telemetry::for_each_column(sample, field, [&](const char*, const auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      if constexpr (std::is_same_v<Value, double>)
        bits.push_back(std::bit_cast<std::uint64_t>(value));
      else if constexpr (!std::is_same_v<Value, telemetry::TickEvents>)
        bits.push_back(static_cast<std::uint64_t>(value));
    });
  });
  for (const telemetry::TickEvent& event : sample.events) {
    bits.push_back(static_cast<std::uint64_t>(event.kind));
    bits.push_back(event.id);
  }
  return bits;
}

}  // namespace trocar::testing
