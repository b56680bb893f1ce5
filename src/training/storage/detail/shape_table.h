#pragma once

#include <limits>
#include <string>
#include <vector>

#include "storage/detail/database.h"
#include "telemetry/needle_shape.h"

namespace trocar::storage::detail {

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
