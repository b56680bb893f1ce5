#pragma once

#include <gtest/gtest.h>

#include <fstream>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/version.h"
#include "exams/exam_result.h"
#include "haptics/force_version.h"

namespace trocar::exams {

inline storage::SessionInfo exam_info() {
  storage::SessionInfo info;
  info.program_version = kVersion;
  info.force_version = haptics::kForceVersion;
  info.started_utc = "2026-02-03T04:05:06Z";
  info.task = "liver-biopsy";
  info.patient_source = "biopsy-2";
  info.patient_hash = "0123456789abcdef";
  info.patient_seed = 4711;
  info.level = "exam";
  info.operator_name = "trainee";
  info.device = "virtual";
  info.attempt_id = "00000000000000000000000000004711";
  info.person_id = "ada";
  info.label_names.resize(256);
  return info;
}

/// Writes a session and returns what the program that wrote it holds in memory.
inline ExamEnd record_exam(const std::filesystem::path& file, const storage::SessionInfo& info, double score = 87.25,
                           bool is_finished = true) {
  ExamEnd end{info, {}, {}, {info.person_id, info.person_id.empty() ? "" : "Ada Lovelace", true}, {}};
  end.data_sha256 = *digest_of_data(data_dir());
  auto writer = storage::SessionWriter::create(file, info);
  EXPECT_TRUE(writer) << writer.error().text();
  EXPECT_TRUE(writer->append(telemetry::TickSample()));
  end.outcome.score = score;
  end.outcome.fails = {"the lung was touched"};
  end.outcome.parts = {{"target", "Distance to the target", 1.5, "mm", 18.0, 20.0}};
  if (is_finished) {
    EXPECT_TRUE(writer->finish(end.outcome, {}));
  }
  end.ticks_hash = writer->ticks_hash();
  return end;
}

inline void overwrite(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace trocar::exams
