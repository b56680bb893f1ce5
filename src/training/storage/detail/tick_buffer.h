#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "storage/detail/checksums.h"
#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "telemetry/tick_sample.h"

namespace trocar::storage::detail {

/// Ticks with their events that are not stored yet, as columns that are bound to statements.
/// Invariant: every column of ticks has the length of `samples()`.
class TickBuffer {
 public:
  TickBuffer() = default;
  TickBuffer(const TickBuffer&) = delete;
  TickBuffer& operator=(const TickBuffer&) = delete;

  /// Throws soci::soci_error.
  void prepare(soci::session& database);
  /// Before the session is closed.
  void end_statements() noexcept;

  void add(const SessionInfo& info, const telemetry::TickSample& sample);
  /// The ticks with the checksum of their block. Throws soci::soci_error.
  void write(soci::session& database);
  void clear() noexcept;

  const std::vector<telemetry::TickSample>& samples() const noexcept { return samples_; }
  bool is_empty() const noexcept { return samples_.empty(); }
  int next_tick() const noexcept { return next_tick_; }

 private:
  void prepare_ticks(soci::session& database);
  void prepare_events(soci::session& database);

  int next_tick_ = 0;
  std::vector<telemetry::TickSample> samples_;
  std::vector<int> tick_column_;
  std::vector<std::vector<double>> real_columns_;
  std::vector<std::vector<soci::indicator>> real_indicators_;
  std::vector<std::vector<int>> integer_columns_;
  struct {
    std::vector<int> tick, slot, kind, id;
    std::vector<std::string> text;
  } events_;
  std::optional<soci::statement> insert_ticks_, insert_events_;
};

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
