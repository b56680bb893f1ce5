#pragma once

#include <limits>
#include <string>
#include <vector>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "telemetry/needle_shape.h"

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

/// The table `needle_shape`: time, and the points beside the straight needle in micrometres, "x y x y …"; an empty text
/// is a straight needle. Sessions of older programs do not have it.
std::string shape_schema();

/// Buffered shapes. Invariant: time rises.
class ShapeBuffer {
 public:
  /// Leaves out a shape that is not later than the last one, or not finite.
  void add(const telemetry::NeedleShape& shape);
  bool is_empty() const noexcept { return times_s_.empty(); }
  /// Throws soci::soci_error.
  void write(soci::session& database);
  void clear() noexcept;

 private:
  std::vector<double> times_s_;
  std::vector<std::string> points_um_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

/// Reads all shapes by time. Throws soci::soci_error, also for an invalid shape.
std::vector<telemetry::NeedleShape> read_shapes(soci::session& database);

}  // namespace trocar::storage::detail
