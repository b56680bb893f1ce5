#pragma once

#include <set>
#include <string>
#include <vector>

#include "storage/detail/checksums.h"
#include "storage/detail/database.h"

namespace trocar::storage::detail {

/// Reads ticks with their events. Columns that a session of an older program lacks have the value of a sample that was
/// never filled.
class TickReader {
 public:
  explicit TickReader(soci::session& database) : database_(&database) {}

  /// The ticks of a block. Throws soci::soci_error (or what SOCI lets through) where one cannot be read, is missing, or
  /// is not what was written.
  std::vector<telemetry::TickSample> read(const TickBlock& block);

 private:
  soci::session* database_;
  std::set<std::string> present_;  ///< Columns of the table; read with the first block.
};

}  // namespace trocar::storage::detail
