#include "web/message.h"

#include <algorithm>

#include "config/json.h"
#include "core/text.h"

namespace trocar::web {
namespace {

template <class IsName>
std::optional<std::string_view> find_single(const TextPairs& pairs, IsName is_name) noexcept {
  std::optional<std::string_view> found;
  for (const auto& [name, value] : pairs) {
    if (!is_name(name)) continue;
    if (found) return std::nullopt;
    found = value;
  }
  return found;
}

}  // namespace

bool is_same_name(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return ascii::to_lower(x) == ascii::to_lower(y); });
}

std::optional<std::string_view> HttpRequest::find_header(std::string_view name) const noexcept {
  return find_single(headers, [&](std::string_view other) { return is_same_name(other, name); });
}

bool HttpRequest::has_header(std::string_view name) const noexcept {
  return std::any_of(headers.begin(), headers.end(), [&](const auto& h) { return is_same_name(h.first, name); });
}

std::optional<std::string_view> HttpRequest::find_query(std::string_view name) const noexcept {
  return find_single(query, [&](std::string_view other) { return other == name; });
}

std::optional<std::string> percent_decoded(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string decoded;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] != '%') {
      decoded += text[n];
      continue;
    }
    if (n + 2 >= text.size()) return std::nullopt;
    const std::size_t high = kDigits.find(ascii::to_lower(text[n + 1])),
                      low = kDigits.find(ascii::to_lower(text[n + 2]));
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    decoded += static_cast<char>(high * kDigits.size() + low);
    n += 2;
  }
  return decoded;
}

HttpAnswer empty_answer(int status) {
  HttpAnswer answer;
  answer.status = status;
  return answer;
}

HttpAnswer text_answer(int status, std::string content_type, std::string body) {
  return {status, std::move(content_type), std::make_shared<const std::string>(std::move(body)), {}, {}};
}

HttpAnswer json_answer(int status, std::string json) {
  return text_answer(status, "application/json; charset=utf-8", std::move(json));
}

HttpAnswer error_answer(int status, std::string_view error, std::string_view advice) {
  return json_answer(status, config::json_text({{"error", error}, {"advice", advice}}, -1));
}

HttpAnswer error_answer(int status, const Error& error) {
  return error_answer(status, error.where.empty() ? error.what : error.what + " — " + error.where, error.advice);
}

}  // namespace trocar::web
