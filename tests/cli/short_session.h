#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scoring/score.h"

namespace trocar::cli_test {

/// A session of one tick, as far as learning path and exams read it.
struct ShortSession {
  std::string started_utc = "2026-01-02T10:11:12Z";
  std::string patient = "biopsy-1";  ///< Of the task liver-biopsy.
  std::uint64_t seed = 1;
  std::string level = "guided";
  double score = 91.0;  ///< Passed.
  std::vector<scoring::ScorePart> parts = {};
  std::string not_scored = {};  ///< Reason; then neither score nor pass.
  double punctures = 1.0;       ///< Of the skin: the needle was in the body.
  bool is_cut = false;          ///< The program was killed: no end.
};
/// Writes it; a test failure if it cannot be written.
void write_session(const std::string& file, const ShortSession& session);

}  // namespace trocar::cli_test
