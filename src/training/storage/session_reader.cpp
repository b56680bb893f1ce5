#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "config/json.h"
#include "storage/detail/checksums.h"
#include "storage/detail/guarded_database.h"
#include "storage/detail/info_table.h"
#include "storage/detail/outcome_json.h"
#include "storage/detail/salvage.h"
#include "storage/session_file.h"
#include "storage/session_summary.h"

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

}  // namespace trocar::storage
