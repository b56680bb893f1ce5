#pragma once

#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <filesystem>
#include <optional>
#include <string>

namespace trocar::database {

/// Opens the SQLite file (created if it is missing), which waits `timeout_s` for another writer. Throws
/// soci::soci_error.
void open_sqlite(soci::session& session, const std::filesystem::path& path, int timeout_s);

/// A PRAGMA's integer value. Throws soci::soci_error.
int pragma_integer(soci::session& session, const std::string& name);

/// SQLite's own handle of an open session, for functions that SOCI does not offer.
inline sqlite_api::sqlite3* handle_of(soci::session& session) {
  return static_cast<soci::sqlite3_session_backend*>(session.get_backend())->conn_;
}

/// How an SQLite file keeps its transactions whole.
struct Journal {
  bool is_write_ahead = false;  ///< False: a rollback journal, with `synchronous` = FULL.
  /// Why the file has no write-ahead log: "nfs is a network file system". Empty: it has one, or it cannot be written.
  std::string obstacle;
};

/// The network or user-space file system of a file (or of its folder, if it does not exist): "nfs". Empty: the file
/// system is local or unknown.
std::optional<std::string> find_network_file_system(const std::filesystem::path& file);

/// Sets the write-ahead log, and reads by it once; where that is impossible, a rollback journal. A write-ahead log
/// needs memory that all its programs share, which no network file system offers. A file with a log of a killed program
/// is recovered first. Throws soci::soci_error: another program uses the file with a write-ahead log; the file cannot
/// be read. `network`: see find_network_file_system.
Journal set_journal(soci::session& session, const std::filesystem::path& file,
                    const std::optional<std::string>& network);

/// Connects again, so that the file can be read where its write-ahead log cannot be shared: this connection then uses
/// it alone, and waits `wait_ms` for others. Throws soci::soci_error, above all where another program uses the file.
void read_without_shared_memory(soci::session& session, int wait_ms = 5000);

}  // namespace trocar::database
