#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/content_hash.h"
#include "storage/detail/database.h"
#include "telemetry/tick_sample.h"

namespace trocar::storage::detail {

/// The tables of checksums. `tick_blocks`: one row a commit, its ticks and their digest. `checksums`: rows and digest
/// of other tables; `tick_blocks` itself only when the session is finished.
std::vector<std::string> checksum_schema();

/// Digest of ticks with their events, over the values as a session keeps them (NaN is one value, -0.0 is 0.0).
/// `present`: the columns of the session's table; nullptr: all.
std::string digest_of(std::span<const telemetry::TickSample> samples, const std::set<std::string>* present = nullptr);
/// Adds ticks to the hash of a whole session.
void add_ticks(ContentHash& hash, std::span<const telemetry::TickSample> samples,
               const std::set<std::string>* present = nullptr);

/// The hash of all ticks of a finished session, in the table `checksums`. Throws soci::soci_error.
void write_ticks_hash(soci::session& database, std::size_t ticks, const std::string& hash);
/// Empty in sessions of older programs. Throws soci::soci_error.
std::string read_ticks_hash(soci::session& database);

/// A block of ticks with one checksum.
struct TickBlock {
  std::size_t first_tick = 0;
  std::size_t ticks = 0;
  std::string digest;  ///< Empty in sessions of older programs.
};
void write_block(soci::session& database, const TickBlock& block);
/// In the order of ticks. Throws soci::soci_error; `blocks` then contains those before the damage.
void read_blocks(soci::session& database, std::vector<TickBlock>& blocks);

struct RowsDigest {
  std::int64_t rows = 0;
  std::string digest;
  bool operator==(const RowsDigest&) const = default;
};
/// Rows and digest of a query's result: every value with its type, bit by bit. Throws soci::soci_error.
RowsDigest digest_of_rows(soci::session& database, const std::string& query);

/// Sets of rows with a checksum of their own in the table `checksums`.
struct CheckedRows {
  const char* name;   ///< In the table `checksums` and in messages.
  const char* query;  ///< In a fixed order.
};
inline constexpr CheckedRows kInfoRows{"info", "SELECT key, value FROM info ORDER BY key"};
inline constexpr CheckedRows kNameRows{
    "names",
    "SELECT 1, id, name FROM tissues UNION ALL SELECT 2, id, name FROM layers UNION ALL "
    "SELECT 3, id, name FROM labels UNION ALL SELECT 4, id, name FROM phases ORDER BY 1, 2"};
inline constexpr CheckedRows kTransducerRows{"transducer", "SELECT * FROM transducer ORDER BY time_s"};
inline constexpr CheckedRows kActionRows{"actions", "SELECT * FROM actions ORDER BY time_s"};
inline constexpr CheckedRows kXrayRows{"xray", "SELECT * FROM xray ORDER BY time_s"};
inline constexpr CheckedRows kShapeRows{"needle_shape", "SELECT * FROM needle_shape ORDER BY time_s"};
inline constexpr CheckedRows kParameterRows{"parameters", "SELECT * FROM parameters ORDER BY tick"};
inline constexpr CheckedRows kInterruptionRows{"interruptions", "SELECT * FROM interruptions ORDER BY tick, from_s"};
inline constexpr CheckedRows kOutcomeRows{"outcome", "SELECT * FROM outcome LIMIT 2"};
inline constexpr CheckedRows kBlockRows{"tick_blocks", "SELECT * FROM tick_blocks ORDER BY first_tick"};

/// Computes a checksum and writes it. Throws soci::soci_error.
void write_checksum(soci::session& database, const CheckedRows& rows);
/// Reads a stored checksum; empty if there is none. Throws soci::soci_error.
std::optional<RowsDigest> read_checksum(soci::session& database, const CheckedRows& rows);

}  // namespace trocar::storage::detail
