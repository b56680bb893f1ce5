#pragma once

#include <set>
#include <string>
#include <vector>

#include "storage/detail/checksums.h"
#include "storage/detail/database.h"

namespace trocar::storage::detail {

/// Reads ticks with their events. Columns that a session of an older program lacks have the default values of a sample.
class TickReader {
 public:
  explicit TickReader(soci::session& database) : database_(&database) {}

  /// The ticks of a block. Throws soci::soci_error (or what SOCI lets through) if one cannot be read, is missing, or
  /// differs from the written tick.
  std::vector<telemetry::TickSample> read(const TickBlock& block);

 private:
  soci::session* database_;
  std::set<std::string> present_;  ///< Columns of the table; read with the first block.
};

}  // namespace trocar::storage::detail
