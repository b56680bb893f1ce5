#pragma once

#include <soci/soci.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "database/database.h"
#include "results/attempt.h"

namespace trocar::results::detail {

/// Writes attempts within a transaction; its functions throw soci::soci_error. It may live as long as the session does:
/// keys of cases and metrics are found once.
class AttemptWriter {
 public:
  AttemptWriter(soci::session& session, const database::Database& database) : session_(session), database_(database) {}

  /// Adds the attempt's row as running if there is none of its id. Error (exit status 2): no such person.
  Status begin(const Attempt& attempt);
  /// Completes an attempt that has not ended, or adds it. Returns its sequence.
  Result<std::int64_t> record(const AttemptRecord& record, std::string_view recording);
  /// Adds an attempt of a table without path and recording, or completes one of which the database knows less (running
  /// before interrupted before ended), and keeps its path and recording. Returns its state; empty: nothing to write.
  Result<std::optional<State>> merge(const AttemptRecord& record);

 private:
  struct Found {
    long long sequence = 0;  ///< 0: there is none.
    State state = State::kRunning;
  };
  Found find_for_update(const std::string& id);
  long long case_key(const Case& the_case);
  long long metric_key(const Measure& measure);
  void update_row(long long sequence, const AttemptRecord& record);
  void replace_texts(long long sequence, const AttemptRecord& record);
  void replace_values(long long sequence, const AttemptRecord& record);
  void replace_recording(long long sequence, std::string_view recording);

  soci::session& session_;
  const database::Database& database_;
  std::map<std::string, long long, std::less<>> metric_keys_, case_keys_;
};

}  // namespace trocar::results::detail
