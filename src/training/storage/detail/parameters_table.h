#pragma once

#include <string>
#include <vector>

#include "storage/detail/database.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// The tables `parameters` (settings joined by `;`, options and tissue table line by line) and `interruptions`.
/// Sessions of older programs do not have them.
std::vector<std::string> parameters_schema();
/// SQL for the view's column `event` of a tick `t` from these tables: SELECTs of one text each, for a UNION ALL.
std::string parameters_events_sql();

/// Buffered rows of the tables.
class ParametersBuffer {
 public:
  void add(const SessionParameters& parameters) { parameters_.push_back(parameters); }
  void add(const tasks::Interruption& interruption, std::size_t tick) {
    interruptions_.push_back({interruption, tick});
  }
  bool is_empty() const noexcept { return parameters_.empty() && interruptions_.empty(); }
  /// Throws soci::soci_error.
  void write(soci::session& database);
  void clear() noexcept;

 private:
  struct InterruptedTick {
    tasks::Interruption interruption;
    std::size_t tick;  ///< The first tick after the interruption.
  };
  std::vector<SessionParameters> parameters_;
  std::vector<InterruptedTick> interruptions_;
};

/// Reads all rows; empty if there is no such table. Throws soci::soci_error, also for a tick that is not below
/// `tick_count`, or a time that is not finite.
std::vector<SessionParameters> read_parameters(soci::session& database, std::size_t tick_count);
std::vector<tasks::Interruption> read_interruptions(soci::session& database);

}  // namespace trocar::storage::detail
