#include "database/server_connection.h"

#include <libpq-fe.h>
#include <soci/postgresql/soci-postgresql.h>

#include <array>
#include <string_view>

namespace trocar::database {
namespace {

/// Seconds, and milliseconds for tcp_user_timeout: a station has to notice a server that is gone.
constexpr std::array kDefaults{std::pair{"connect_timeout", "5"}, std::pair{"tcp_user_timeout", "10000"},
                               std::pair{"keepalives_idle", "10"}, std::pair{"keepalives_interval", "5"},
                               std::pair{"application_name", "trocar"}};

void ignore_notice(void*, const char*) {}

PGconn* connection_of(soci::session& session) noexcept {
  auto* const backend = static_cast<soci::postgresql_session_backend*>(session.get_backend());
  return backend == nullptr ? nullptr : backend->conn_;
}

struct Known {
  std::string_view sqlstate;  ///< Or its first two characters (the class). PostgreSQL documentation, appendix A.
  const char* what;
  const char* advice;
};
constexpr std::array kKnown{
    Known{"28", "the server refuses the user or the password", "check both in the URL"},
    Known{"3D000", "the server has no such database", "ask its administrator to make it (createdb)"},
    Known{"42501", "the user may not do this",
          "a program with the rights of the owner makes or updates the tables; ask the administrator for other rights"},
    Known{"40", "another program wrote the same data at the same time", "try again"},
    Known{"53100", "the server's disk is full", "ask its administrator; nothing of this was written"},
    Known{"53300", "the server has too many connections", "try again, or ask its administrator"},
    Known{"25006", "the database can only be read", "connect to the server that can be written"},
    Known{"XX001", "the database is damaged", "ask its administrator to restore a backup"},
    Known{"XX002", "the database is damaged", "ask its administrator to restore a backup"},
};

/// The messages that libpq gives before a server has answered, when there is no SQLSTATE.
std::optional<Error> connection_error(std::string_view text, const std::string& where) {
  const auto has = [&](std::string_view words) { return text.find(words) != std::string_view::npos; };
  if (has("password authentication failed") || has("no password supplied"))
    return Error{"the server refuses the user or the password", where, "check both in the URL"};
  if (has("database \"") && has("does not exist"))
    return Error{"the server has no such database", where, "ask its administrator to make it (createdb)"};
  if (has("could not translate host name"))
    return Error{"the server's name is unknown", where, "check the host in the URL"};
  if (has("Connection refused") || has("No such file or directory") || has("timeout expired") || has("timed out"))
    return Error{"no server answers", where, "check host and port, and that the server runs"};
  if (has("invalid URI") || has("invalid connection option") || has("invalid port") || has("invalid sslmode"))
    return Error{"the URL is not understood", where, "give postgresql://USER:PASSWORD@HOST:PORT/NAME", 2};
  return std::nullopt;
}

}  // namespace

void open_server(soci::session& session, const std::string& url) {
  std::string text = url;
  for (const auto& [key, value] : kDefaults) {
    if (text.find(std::string(key) + "=") != std::string::npos) continue;
    text += text.find('?') == std::string::npos ? '?' : '&';
    text += std::string(key) + "=" + value;
  }
  session.open(soci::postgresql, text);
  PQsetNoticeProcessor(connection_of(session), &ignore_notice, nullptr);
  session << "SET client_min_messages = error";
  session << "SET extra_float_digits = 3";  // doubles come back bit by bit
}

bool is_lost(soci::session& session) noexcept {
  PGconn* const connection = connection_of(session);
  return connection == nullptr || PQstatus(connection) == CONNECTION_BAD;
}

bool is_conflict(const std::exception& error) noexcept {
  const auto* known = dynamic_cast<const soci::postgresql_soci_error*>(&error);
  if (known == nullptr) return false;
  // unique_violation, foreign_key_violation, serialization_failure, deadlock_detected
  for (const std::string_view conflict : {"23505", "23503", "40001", "40P01"})
    if (known->sqlstate() == conflict) return true;
  return false;
}

std::optional<Error> server_error(const std::exception& error, const std::string& where) {
  if (const auto* known = dynamic_cast<const soci::postgresql_soci_error*>(&error)) {
    const std::string sqlstate = known->sqlstate();
    for (const Known& one : kKnown)
      if (sqlstate.starts_with(one.sqlstate)) return Error{one.what, where, one.advice};
  }
  return connection_error(error.what(), where);
}

}  // namespace trocar::database
