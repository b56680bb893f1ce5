#include "cli/short_session.h"

#include <gtest/gtest.h>

#include "storage/session_file.h"

namespace trocar::cli_test {

void write_session(const std::string& file, const ShortSession& session) {
  storage::SessionInfo info;
  info.started_utc = session.started_utc;
  info.task = "liver-biopsy";
  info.patient_source = session.patient;
  info.patient_seed = session.seed;
  info.level = session.level;
  info.label_names.resize(256);
  auto writer = storage::SessionWriter::create(file, info);
  ASSERT_TRUE(writer) << writer.error().text();
  ASSERT_TRUE(writer->append(telemetry::TickSample()));
  if (session.is_cut) return;
  scoring::Outcome outcome;
  outcome.not_scored = session.not_scored;
  if (outcome.is_scored()) {
    outcome.score = session.score;
    outcome.is_passed = true;
  }
  outcome.measures = {{"skin_punctures", session.punctures, "1", {}, {}, {}}};
  outcome.parts = session.parts;
  ASSERT_TRUE(writer->finish(outcome, {}));
}

}  // namespace trocar::cli_test
