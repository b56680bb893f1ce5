#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "storage/detail/database.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// The table `transducer`: time, origin and rotation of X_PT, force of contact; real numbers, none is missing. Sessions
/// of older programs do not have it.
inline constexpr std::array kTransducerColumns{"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "contact_n"};

std::string transducer_schema();

/// Buffered samples of the table. Invariant: columns of one length; time rises.
class TransducerBuffer {
 public:
  /// Leaves out a sample that is not later than the last one, or not finite.
  void add(const TransducerSample& sample);
  bool is_empty() const noexcept { return columns_[0].empty(); }
  double span_s() const noexcept { return is_empty() ? 0.0 : columns_[0].back() - columns_[0].front(); }
  /// Throws soci::soci_error.
  void write(soci::session& database);
  void clear() noexcept;

 private:
  std::array<std::vector<double>, kTransducerColumns.size()> columns_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

/// Reads all samples by time; empty if there is no such table. Throws soci::soci_error, also for an invalid pose.
std::vector<TransducerSample> read_transducer(soci::session& database);

}  // namespace trocar::storage::detail
