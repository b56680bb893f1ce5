#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "tasks/action.h"

namespace trocar::storage::detail {

/// A table of real numbers by time; the first column is the time, none is missing. Sessions of older programs may lack
/// it.
struct TimedTable {
  const char* name;
  std::vector<const char*> columns;
  std::size_t most_rows;  ///< A longer table is refused.
};

std::string schema_of(const TimedTable& table);

/// Buffered rows of such a table. Invariant: columns of one length; time rises.
class TimedBuffer {
 public:
  explicit TimedBuffer(const TimedTable& table) : table_(table), columns_(table.columns.size()) {}
  /// Leaves out a row that is not later than the last one, or not finite.
  void add(std::span<const double> row);
  bool is_empty() const noexcept { return columns_.front().empty(); }
  double span_s() const noexcept { return is_empty() ? 0.0 : columns_.front().back() - columns_.front().front(); }
  /// Throws soci::soci_error.
  void write(soci::session& database);
  void clear() noexcept;

 private:
  const TimedTable& table_;
  std::vector<std::vector<double>> columns_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

/// Reads all rows by time; none if there is no such table. Throws soci::soci_error.
std::vector<std::vector<double>> read_rows(soci::session& database, const TimedTable& table);

bool all_finite(std::span<const double> row) noexcept;

/// The table `actions`: time, kind, amount, what came back, place of the tip.
const TimedTable& action_table();
void add(TimedBuffer& buffer, const tasks::Action& action);
/// Throws soci::soci_error, also for a kind or substance that does not exist.
std::vector<tasks::Action> read_actions(soci::session& database);

/// The table `transducer`: time, origin and rotation of X_PT, force of contact.
const TimedTable& transducer_table();
void add(TimedBuffer& buffer, const TransducerSample& sample);
/// Throws soci::soci_error, also for an invalid pose.
std::vector<TransducerSample> read_transducer(soci::session& database);

/// The table `xray`: time, place of the C-arm, whether the beam is on, contrast agent and dose up to then.
const TimedTable& xray_table();
void add(TimedBuffer& buffer, const tasks::XrayUse& use);
/// Throws soci::soci_error, also for a dose that is negative.
std::vector<tasks::XrayUse> read_xray(soci::session& database);

}  // namespace trocar::storage::detail
