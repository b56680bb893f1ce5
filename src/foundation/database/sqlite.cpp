#include "database/sqlite.h"

#include <fmt/format.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

namespace trocar::database {

void open_sqlite(soci::session& session, const std::filesystem::path& path, int timeout_s) {
  const std::string absolute = std::filesystem::absolute(path).string();
  if (absolute.find('"') != std::string::npos) throw soci::soci_error("a quotation mark in the path");
  session.open(soci::sqlite3, fmt::format("dbname=\"{}\" timeout={}", absolute, timeout_s));
}

int pragma_integer(soci::session& session, const std::string& name) {
  int value = 0;
  session << "PRAGMA " + name, soci::into(value);
  return value;
}

namespace fs = std::filesystem;
namespace {

/// Magic numbers of statfs(2), and of fs/*/ in Linux where its page lists none.
constexpr std::array<std::pair<std::uint32_t, const char*>, 13> kNetworkFileSystems{{
    {0x6969, "nfs"},
    {0x517b, "smb"},
    {0xff534d42, "cifs"},
    {0xfe534d42, "smb2"},
    {0x01021997, "9p"},
    {0x65735546, "fuse"},
    {0x5346414f, "afs"},
    {0x6b414653, "kafs"},
    {0x73757245, "coda"},
    {0x00c36400, "ceph"},
    {0x0bd00bd0, "lustre"},
    {0x47504653, "gpfs"},
    {0x7461636f, "ocfs2"},
}};

void read_schema(soci::session& session) {
  int tables = 0;
  session << "SELECT count(*) FROM sqlite_master", soci::into(tables);
}

/// The answer of SQLite: the mode that is in force from now on, which is not always the one that was named.
std::string answer_to(soci::session& session, const std::string& pragma) {
  std::string answer;
  session << "PRAGMA " + pragma, soci::into(answer);
  return answer;
}

int primary_code(const soci::soci_error& error) {
  const auto* const sqlite = dynamic_cast<const soci::sqlite3_soci_error*>(&error);
  return sqlite != nullptr ? sqlite->result() & 0xff : SQLITE_ERROR;
}

/// True for the errors of a shared memory that cannot be made, and of a file that cannot be written.
bool is_without_log(const soci::soci_error& error) {
  const int code = primary_code(error);
  return code == SQLITE_IOERR || code == SQLITE_CANTOPEN || code == SQLITE_READONLY || code == SQLITE_PROTOCOL;
}

/// True if the file cannot be written, or no journal beside it.
bool is_read_only(soci::session& session, const fs::path& file) {
  return sqlite_api::sqlite3_db_readonly(handle_of(session), "main") == 1 ||
         ::access(fs::absolute(file).parent_path().c_str(), W_OK) != 0;
}

enum class Mode { kLog, kUnreadableLog, kRollback };

/// The mode of the file, which it has kept since it was last set.
Mode mode_of(soci::session& session) {
  try {
    const bool is_log = answer_to(session, "journal_mode") == "wal";
    read_schema(session);
    return is_log ? Mode::kLog : Mode::kRollback;
  } catch (const soci::soci_error& error) {
    if (!is_without_log(error)) throw;
    return Mode::kUnreadableLog;
  }
}

/// True if SQLite's answer is the log, and the file can be read by it: it answers before it has tried the shared
/// memory.
bool has_set_log(soci::session& session) {
  try {
    if (answer_to(session, "journal_mode = WAL") != "wal") return false;
    read_schema(session);
    return true;
  } catch (const soci::soci_error& error) {
    if (!is_without_log(error)) throw;
    return false;
  }
}

/// Tries a log on a file of its own: the attempt would stop other programs that use the database.
bool can_have_log(const fs::path& file) {
  std::string name = fs::absolute(file).string() + ".XXXXXX";
  const int made = ::mkstemp(name.data());
  if (made < 0) return false;
  ::close(made);
  bool is_possible = false;
  try {
    soci::session session;
    open_sqlite(session, name, 1);
    is_possible = has_set_log(session);
  } catch (const soci::soci_error&) {
    // is_possible stays false
  }
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(name + suffix, ignored);
  return is_possible;
}

/// Converts a file with a log. Two programs that do so at once hinder each other: they wait for different times.
void set_rollback_journal(soci::session& session) {
  constexpr int kMostTries = 8;
  for (int tries = 1;; ++tries) {
    try {
      read_without_shared_memory(session, 50 + 37 * static_cast<int>(::getpid() % 4));
      if (answer_to(session, "journal_mode = DELETE") != "delete")
        throw soci::soci_error("its write-ahead log cannot be ended");
      return session.reconnect();  // gives the lock back
    } catch (const soci::soci_error& error) {
      if (primary_code(error) != SQLITE_BUSY || tries >= kMostTries) throw;
      session.reconnect();
      std::this_thread::sleep_for(std::chrono::milliseconds(20 * (1 + ::getpid() % 5)));
      if (mode_of(session) == Mode::kRollback) return;  // the other program has done it
    }
  }
}

}  // namespace

std::optional<std::string> find_network_file_system(const fs::path& file) {
  struct statfs found {};
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error);
  if (::statfs(absolute.c_str(), &found) != 0 && ::statfs(absolute.parent_path().c_str(), &found) != 0)
    return std::nullopt;
  const auto type = static_cast<std::uint32_t>(found.f_type);
  for (const auto& [magic, name] : kNetworkFileSystems)
    if (type == magic) return name;
  return std::nullopt;
}

void read_without_shared_memory(soci::session& session, int wait_ms) {
  session.reconnect();  // a connection that has tried the shared memory never does without it
  sqlite_api::sqlite3_busy_timeout(handle_of(session), wait_ms);
  answer_to(session, "locking_mode = EXCLUSIVE");
  read_schema(session);
}

Journal set_journal(soci::session& session, const fs::path& file, const std::optional<std::string>& network) {
  if (is_read_only(session, file)) {
    read_schema(session);
    return {};
  }
  const Mode mode = mode_of(session);
  if (!network) {
    if (mode == Mode::kLog) return {true, {}};
    if (mode == Mode::kRollback && can_have_log(file) && has_set_log(session)) return {true, {}};
  }
  if (mode_of(session) != Mode::kRollback) set_rollback_journal(session);
  session << "PRAGMA synchronous = FULL";
  return {false, network ? fmt::format("{} {} a network file system", *network, *network == "fuse" ? "can be" : "is")
                         : "its file system shares no memory between programs"};
}

}  // namespace trocar::database
