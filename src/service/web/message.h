#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"

namespace trocar::web {

using TextPairs = std::vector<std::pair<std::string, std::string>>;

/// A request of HTTP, read completely and not judged yet: every text is the client's.
struct HttpRequest {
  std::string method = "GET";
  std::string path = "/";  ///< As it was sent, still percent-encoded, without the query.
  TextPairs query;         ///< Decoded, in the order of the request.
  TextPairs headers;       ///< Names as the client wrote them.
  std::string body;
  std::string address;  ///< Of the client: "127.0.0.1".
  std::string client;   ///< Whom limits of rates are for: see client_of.

  /// The value of a header by its name in lower case. Empty: missing, or sent more than once.
  std::optional<std::string_view> find_header(std::string_view name) const noexcept;
  bool has_header(std::string_view name) const noexcept;
  /// The value of a parameter of the query. Empty: missing, or sent more than once.
  std::optional<std::string_view> find_query(std::string_view name) const noexcept;
};

/// Content that is made while it is sent: the next piece; empty: the end. After an error the connection is cut, so that
/// the client sees that content is missing.
using ContentSource = std::function<Result<std::string>()>;

struct HttpAnswer {
  int status = 200;
  std::string content_type;                 ///< Empty: no content.
  std::shared_ptr<const std::string> body;  ///< Null: no content, or a source.
  TextPairs headers;
  ContentSource source = {};
};

/// A percent-encoded text; empty: malformed ("%2", "%zz").
std::optional<std::string> percent_decoded(std::string_view text);

/// Whether two names of headers, schemes or hosts are the same without regard to the case of ASCII letters.
bool is_same_name(std::string_view a, std::string_view b) noexcept;

HttpAnswer empty_answer(int status);
HttpAnswer text_answer(int status, std::string content_type, std::string body);
HttpAnswer json_answer(int status, std::string json);
/// {"error": "what — where", "advice": "…"}. `where` must not name a file or a table of the server.
HttpAnswer error_answer(int status, std::string_view error, std::string_view advice);
/// The same for an error that a user's input has caused.
HttpAnswer error_answer(int status, const Error& error);

}  // namespace trocar::web
