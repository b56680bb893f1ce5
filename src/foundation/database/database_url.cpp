#include "database/database_url.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace trocar::database {
namespace {

constexpr const char* kAdvice = "give a file, or postgresql://USER@HOST/NAME";

/// Scheme of a URL: letters and digits before "://", or "sqlite:"; empty: a file.
std::string_view scheme_of(std::string_view text) {
  if (text.starts_with("sqlite:")) return "sqlite";
  const std::size_t end = text.find("://");
  if (end == std::string_view::npos) return {};
  const std::string_view scheme = text.substr(0, end);
  const bool is_word = std::all_of(scheme.begin(), scheme.end(), ascii::is_letter_or_digit);
  return is_word ? scheme : std::string_view();
}

/// The value of a parameter "password" in the query is hidden as well.
void hide_parameter(std::string& url) {
  for (const std::string_view key : {"?password=", "&password="})
    if (const std::size_t at = url.find(key); at != std::string::npos) {
      const std::size_t from = at + key.size();
      url.replace(from, std::min(url.find('&', from), url.size()) - from, "...");
    }
}

Result<DatabaseUrl> parse_server(std::string_view text) {
  const std::size_t host = text.find("://") + 3;
  const std::size_t path = text.find('/', host);
  const std::string_view name =
      path == std::string_view::npos ? std::string_view() : text.substr(path + 1, text.find('?', path) - path - 1);
  DatabaseUrl url{{}, "postgresql://" + std::string(text.substr(host))};
  if (name.empty()) return fail_usage("the URL names no database", url.shown(), kAdvice);
  return url;
}

}  // namespace

std::string DatabaseUrl::shown() const {
  if (is_sqlite()) return file.string();
  std::string text = server;
  const std::size_t host = text.find("://") + 3;
  const std::size_t end = std::min(text.find_first_of("/?", host), text.size());
  if (const std::size_t at = text.rfind('@', end); at != std::string::npos && at > host) {
    const std::size_t colon = text.find(':', host);
    if (colon < at) text.erase(colon, at - colon);
  }
  hide_parameter(text);
  return text;
}

Result<DatabaseUrl> parse_url(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return fail_usage("the URL contains a NUL byte", "--db", kAdvice);
  const std::string_view scheme = scheme_of(text);
  if (scheme == "postgresql" || scheme == "postgres") return parse_server(text);
  if (scheme == "sqlite") {
    text.remove_prefix(std::string_view("sqlite:").size());
    if (text.starts_with("//")) text.remove_prefix(2);
  } else if (!scheme.empty()) {
    return fail_usage(fmt::format("\"{}\" is no kind of database", scheme), fmt::format("{}://…", scheme), kAdvice);
  }
  if (text.empty()) return fail_usage("the database has no name", "--db", kAdvice);
  return DatabaseUrl{std::filesystem::path(text), {}};
}

}  // namespace trocar::database
