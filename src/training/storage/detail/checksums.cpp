#include "storage/detail/checksums.h"

#include <cmath>
#include <limits>
#include <memory>

#include "storage/detail/columns.h"
#include "storage/detail/database.h"
#include "storage/ticks_hash.h"

namespace trocar::storage::detail {
namespace {

constexpr std::size_t kDigestDigits = 32;
constexpr const char* kTicksName = "ticks";  ///< Of the hash of all ticks in the table `checksums`.

template <class Value>
void add(ContentHash& hash, const Value& value) {
  hash.add(std::as_bytes(std::span(&value, 1)));
}

double kept(double value) noexcept {
  return std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value + 0.0;
}

struct Finalize {
  void operator()(sqlite_api::sqlite3_stmt* statement) const { sqlite_api::sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite_api::sqlite3_stmt, Finalize>;

[[noreturn]] void throw_error(sqlite_api::sqlite3* handle) {
  throw soci::soci_error(sqlite_api::sqlite3_errmsg(handle));
}

void add_value(ContentHash& hash, sqlite_api::sqlite3_stmt* statement, int column) {
  const int type = sqlite_api::sqlite3_column_type(statement, column);
  add(hash, type);
  if (type == SQLITE_INTEGER) {
    add(hash, sqlite_api::sqlite3_column_int64(statement, column));
  } else if (type == SQLITE_FLOAT) {
    add(hash, sqlite_api::sqlite3_column_double(statement, column));
  } else if (type != SQLITE_NULL) {
    const auto* bytes = static_cast<const std::byte*>(sqlite_api::sqlite3_column_blob(statement, column));
    const int count = sqlite_api::sqlite3_column_bytes(statement, column);
    add(hash, count);
    if (bytes != nullptr) hash.add(std::span(bytes, static_cast<std::size_t>(count)));
  }
}

void insert_digest(soci::session& database, const std::string& name, const RowsDigest& digest) {
  const long long count = digest.rows;
  database << "INSERT INTO checksums (name, row_count, digest) VALUES (:name, :count, :digest)", soci::use(name),
      soci::use(count), soci::use(digest.digest);
}

std::optional<RowsDigest> read_digest(soci::session& database, const std::string& name) {
  long long count = 0;
  std::string digest;
  database << "SELECT row_count, digest FROM checksums WHERE name = :name", soci::use(name), soci::into(count),
      soci::into(digest);
  if (digest.empty()) return std::nullopt;
  return RowsDigest{count, digest};
}

}  // namespace

std::vector<std::string> checksum_schema() {
  return {"CREATE TABLE tick_blocks (first_tick INTEGER PRIMARY KEY, ticks INTEGER NOT NULL, digest TEXT NOT NULL)",
          "CREATE TABLE checksums (name TEXT PRIMARY KEY, row_count INTEGER NOT NULL, digest TEXT NOT NULL) WITHOUT "
          "ROWID"};
}

void add_ticks(ContentHash& hash, std::span<const telemetry::TickSample> samples,
               const std::set<std::string>* present) {
  std::vector<double> values;
  for (const telemetry::TickSample& sample : samples) {
    values.clear();
    visit_stored_columns(sample, [&](const char* name, const auto& field) {
      if (present != nullptr && !present->contains(name)) return;
      if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>)
        values.push_back(kept(field));
      else
        values.push_back(static_cast<double>(field));
    });
    for (const telemetry::TickEvent& event : sample.events) {
      values.push_back(static_cast<double>(event.kind));
      values.push_back(event.kind == telemetry::EventKind::kNone ? 0.0 : static_cast<double>(event.id));
    }
    hash.add(std::as_bytes(std::span(values)));
  }
}

std::string digest_of(std::span<const telemetry::TickSample> samples, const std::set<std::string>* present) {
  ContentHash hash;
  add_ticks(hash, samples, present);
  return hash.digest();
}

void write_block(soci::session& database, const TickBlock& block) {
  const auto first_tick = static_cast<long long>(block.first_tick);
  const auto ticks = static_cast<long long>(block.ticks);
  database << "INSERT INTO tick_blocks (first_tick, ticks, digest) VALUES (:first, :ticks, :digest)",
      soci::use(first_tick), soci::use(ticks), soci::use(block.digest);
}

void read_blocks(soci::session& database, std::vector<TickBlock>& blocks) {
  long long first_tick = 0;
  long long ticks = 0;
  std::string digest;
  soci::statement select = (database.prepare << "SELECT first_tick, ticks, digest FROM tick_blocks ORDER BY first_tick",
                            soci::into(first_tick), soci::into(ticks), soci::into(digest));
  select.execute();
  while (select.fetch()) {
    const std::size_t end = blocks.empty() ? 0 : blocks.back().first_tick + blocks.back().ticks;
    const bool is_valid = first_tick >= static_cast<long long>(end) && ticks > 0 &&
                          first_tick + ticks < std::numeric_limits<int>::max() && digest.size() == kDigestDigits;
    if (!is_valid || blocks.size() >= kMaxBlocks) throw soci::soci_error("a block of ticks is out of order");
    blocks.push_back({static_cast<std::size_t>(first_tick), static_cast<std::size_t>(ticks), digest});
  }
}

RowsDigest digest_of_rows(soci::session& database, const std::string& query) {
  sqlite_api::sqlite3* const handle = handle_of(database);
  sqlite_api::sqlite3_stmt* prepared = nullptr;
  if (sqlite_api::sqlite3_prepare_v2(handle, query.c_str(), -1, &prepared, nullptr) != SQLITE_OK) throw_error(handle);
  const Statement statement(prepared);
  RowsDigest digest;
  ContentHash hash;
  int state = SQLITE_ROW;
  while ((state = sqlite_api::sqlite3_step(prepared)) == SQLITE_ROW) {
    ++digest.rows;
    const int columns = sqlite_api::sqlite3_column_count(prepared);
    for (int column = 0; column < columns; ++column) add_value(hash, prepared, column);
  }
  if (state != SQLITE_DONE) throw_error(handle);
  digest.digest = hash.digest();
  return digest;
}

void write_checksum(soci::session& database, const CheckedRows& rows) {
  insert_digest(database, rows.name, digest_of_rows(database, rows.query));
}

void write_ticks_hash(soci::session& database, std::size_t ticks, const std::string& hash) {
  insert_digest(database, kTicksName, {static_cast<std::int64_t>(ticks), hash});
}

std::string read_ticks_hash(soci::session& database) {
  const auto written = read_digest(database, kTicksName);
  return written && written->digest.size() == kDigestDigits ? written->digest : std::string();
}

std::optional<RowsDigest> read_checksum(soci::session& database, const CheckedRows& rows) {
  return read_digest(database, rows.name);
}
}  // namespace trocar::storage::detail

namespace trocar::storage {

std::string hash_ticks(std::span<const telemetry::TickSample> samples) {
  return detail::digest_of(samples);
}

}  // namespace trocar::storage
