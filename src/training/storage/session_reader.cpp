#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "config/json.h"
#include "storage/detail/checksums.h"
#include "storage/detail/database.h"
#include "storage/detail/info_table.h"
#include "storage/detail/salvage.h"
#include "storage/score_json.h"
#include "storage/session_file.h"

namespace trocar::storage {
namespace fs = std::filesystem;
using namespace detail;
namespace {

constexpr const char* kAdvice = "name a file made by `trocar run`";

/// Checks the first bytes, so that SQLite never opens (or creates) a file that is not a database.
Status check_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return fail("no such session", path.string(), "check the path");
  if (error) return fail("cannot be read: " + error.message(), path.string(), "check the permissions");
  if (fs::is_directory(status)) return fail("is a folder, not a session", path.string(), kAdvice);
  if (!fs::is_regular_file(status)) return fail("is not a file", path.string(), kAdvice);
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail("cannot be read", path.string(), "check the permissions");
  std::array<char, 16> head{};
  file.read(head.data(), head.size());
  if (file.gcount() == 0) return fail("is empty, not a session", path.string(), kAdvice);
  if (std::memcmp(head.data(), "SQLite format 3", head.size()) != 0)
    return fail("is not a session", path.string(), kAdvice);
  return {};
}

Status check_identity(soci::session& database, const fs::path& path) {
  if (pragma_integer(database, "application_id") != kApplicationId)
    return fail("is a database, but not a session", path.string(), kAdvice);
  const int version = pragma_integer(database, "user_version");
  if (version > kSessionFormatVersion)
    return fail(fmt::format("the session has format {}, this program reads up to {}", version, kSessionFormatVersion),
                path.string(), "use a newer program");
  if (version < 1) return fail(fmt::format("the session has the unknown format {}", version), path.string(), kAdvice);
  return {};
}

void apply(const SessionParameters& first, SessionInfo& info) {
  constexpr std::string_view kForceModel = "force_model=";
  info.tissue_table_toml = first.tissue_table_toml;
  for (const std::string& option : first.options)
    if (option.starts_with(kForceModel)) info.force_model = option.substr(kForceModel.size());
}

/// A killed session needs its folder: SQLite creates an index of the -wal file there, and removes the -journal file.
const char* open_advice(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path.string() + "-wal", error))
    return "the program was killed during recording: copy the session and its -wal file to a writable folder";
  if (fs::exists(path.string() + "-journal", error))
    return "the program was killed during recording: copy the session and its -journal file to a writable folder";
  return "check the file; if it was copied, copy it again";
}

/// Throws soci::soci_error if rows differ from their checksum. A session of an older program has none.
void require_unchanged(GuardedDatabase& database, const CheckedRows& rows, const char* part) {
  if (!database.has_table("checksums")) return;
  const auto written = read_checksum(database.session(), rows);
  if (!written || digest_of_rows(database.session(), rows.query) != *written)
    throw soci::soci_error(fmt::format("the {} is damaged", part));
}

/// Returns the outcome's JSON, empty if there is none. Throws soci::soci_error.
std::string read_summary(GuardedDatabase& database, SessionInfo& info) {
  for (const char* table : {"info", "tissues", "layers", "labels", "phases", "outcome"}) database.require_table(table);
  if (database.has_table("checksums")) database.require_table("checksums");
  info = read_info(database.session());
  require_unchanged(database, kInfoRows, "info");
  std::string json;
  soci::indicator indicator = soci::i_null;
  database.session() << "SELECT json FROM outcome LIMIT 1", soci::into(json, indicator);
  const bool is_finished = database.session().got_data() && indicator == soci::i_ok && !json.empty();
  const bool was_finished =
      database.has_table("checksums") && read_checksum(database.session(), kOutcomeRows).has_value();
  if (!is_finished && !was_finished) return {};
  require_unchanged(database, kOutcomeRows, "outcome");
  return json;
}

/// The damaged parts, with the name of the first.
std::string damage_text(const Session& session) {
  constexpr std::size_t kNamed = 8;
  std::string text;
  for (std::size_t n = 0; n < std::min(kNamed, session.damage.size()); ++n)
    text += (n == 0 ? "" : ", ") + session.damage[n].part;
  if (session.damage.size() > kNamed) text += fmt::format(" and {} more parts", session.damage.size() - kNamed);
  return text;
}

}  // namespace

Error damage_error(const Session& session, const fs::path& path, const std::string& advice) {
  return {"the session is damaged: " + damage_text(session), path.string(), advice, 1};
}

Result<Session> salvage_session(const fs::path& path) {
  TROCAR_TRY_STATUS(check_file(path));
  Session session;
  std::string outcome_json;
  Status identity;
  bool is_exhausted = false;
  const Status read = guarded("the session cannot be read", path, open_advice(path), [&] {
    GuardedDatabase database(path);
    identity = check_identity(database.session(), path);
    if (!identity) return;
    try {
      outcome_json = salvage(database, session);
    } catch (const std::exception&) {
      is_exhausted = database.is_exhausted();
      throw;
    }
    is_exhausted = database.is_exhausted();
  });
  if (is_exhausted)
    return fail("not a session: reading it requires more work than a session of its size", path.string(), kAdvice);
  TROCAR_TRY_STATUS(read);
  TROCAR_TRY_STATUS(identity);
  if (!session.damage.empty() && session.samples.empty())
    return tl::unexpected(damage_error(session, path, "nothing can be read; if it was copied, copy it again"));
  // The info was written before the first tick, at which the server reports the actual parameters.
  if (!session.parameters.empty() && session.parameters.front().tick == 0)
    apply(session.parameters.front(), session.info);
  if (!outcome_json.empty()) {
    TROCAR_TRY(session.outcome, outcome_from_json(outcome_json, path.string()));
  }
  return session;
}

Result<Session> load_session(const fs::path& path) {
  TROCAR_TRY(Session session, salvage_session(path));
  if (session.damage.empty()) return session;
  return tl::unexpected(damage_error(session, path, "save the rest with trocar session export"));
}

Result<SessionSummary> load_summary(const fs::path& path) {
  TROCAR_TRY_STATUS(check_file(path));
  SessionSummary summary;
  std::string json;
  Status identity;
  TROCAR_TRY_STATUS(guarded("the session cannot be read", path, open_advice(path), [&] {
    GuardedDatabase database(path);
    identity = check_identity(database.session(), path);
    if (identity) json = read_summary(database, summary.info);
  }));
  TROCAR_TRY_STATUS(identity);
  if (json.empty()) return summary;
  TROCAR_TRY(summary.outcome, outcome_from_json(json, path.string()));
  return summary;
}

namespace fs = std::filesystem;
using namespace detail;
namespace {

/// True for a session without an outcome. One without ticks may not have its tables yet.
bool is_incomplete(soci::session& database) {
  if (pragma_integer(database, "application_id") != kApplicationId) return false;
  int tables = 0;
  int outcomes = 0;
  database << "SELECT count(*) FROM sqlite_master WHERE name = 'outcome' AND type = 'table'", soci::into(tables);
  if (tables > 0) database << "SELECT count(*) FROM outcome", soci::into(outcomes);
  return outcomes == 0;
}

/// A free name next to the session: first.incomplete.session, first.incomplete-2.session …
fs::path free_name(const fs::path& path) {
  std::error_code ignored;
  for (int n = 1;; ++n) {
    const std::string number = n == 1 ? std::string() : fmt::format("-{}", n);
    const fs::path name =
        path.parent_path() / fmt::format("{}.incomplete{}{}", path.stem().string(), number, path.extension().string());
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

/// One file with a rollback journal, which no other program uses. Throws soci::soci_error.
void take_alone(soci::session& database) {
  constexpr int kWaitForReader_ms = 200;
  set_wait(database, kWaitForReader_ms);
  std::string mode;
  database << "PRAGMA journal_mode = DELETE", soci::into(mode);
  if (mode != "delete") throw soci::soci_error("it is locked");
  database << "BEGIN EXCLUSIVE";
  database << "COMMIT";
}

/// True for the file of an interrupted program: an incomplete session, now in one file, or an empty file.
Result<bool> make_single(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  if (fs::file_size(path, ignored) == 0) return true;
  bool is_left = false;
  bool is_checked = false;
  const Status status = guarded("cannot write: another program is writing this session", path,
                                "wait for it, or choose another name", [&] {
                                  soci::session database;
                                  open_existing(database, path);
                                  is_left = is_incomplete(database);
                                  is_checked = true;
                                  if (is_left) take_alone(database);
                                });
  if (!is_checked) return false;  // not a database: a file of another program
  TROCAR_TRY_STATUS(status);
  return is_left;
}

}  // namespace

std::vector<fs::path> session_files(const fs::path& path) {
  return {path, path.string() + "-wal", path.string() + "-shm", path.string() + "-journal"};
}

Status copy_session(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, error);
  for (const char* log : {"-wal", "-journal"}) {
    const fs::path beside = from.string() + log;
    if (!error && fs::exists(beside)) fs::copy_file(beside, to.string() + log, error);
  }
  if (error) return fail("the session cannot be copied: " + error.message(), from.string(), "check the free space");
  TROCAR_TRY_STATUS(make_single(to));
  return {};
}

Result<std::optional<fs::path>> set_aside_incomplete_session(const fs::path& path) {
  TROCAR_TRY(const bool is_left, make_single(path));
  if (!is_left) return std::nullopt;
  const fs::path name = free_name(path);
  std::error_code error;
  fs::rename(path, name, error);
  if (error)
    return fail("cannot rename the incomplete session: " + error.message(), path.string(), "choose another name");
  return name;
}

}  // namespace trocar::storage
