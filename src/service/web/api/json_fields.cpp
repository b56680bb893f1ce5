#include "web/api/json_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/utf8.h"

namespace trocar::web {

Result<std::string> text_field(const Json& body, const char* name, std::size_t most_bytes) {
  if (!body.is_object() || !body.contains(name)) return fail_usage("a field is missing", name, "send it as a text");
  const Json& field = body.at(name);
  if (!field.is_string()) return fail_usage("a field is not a text", name, "send it as a text");
  const auto& text = field.get_ref<const std::string&>();
  if (text.size() > most_bytes) return fail_usage("a text is too long", name, "shorten it");
  if (valid_utf8(text) != text) return fail_usage("a text is not UTF-8", name, "write it again");
  return text;
}

Result<std::string> text_field_or_empty(const Json& body, const char* name, std::size_t most_bytes) {
  if (body.is_object() && (!body.contains(name) || body.at(name).is_null())) return std::string();
  return text_field(body, name, most_bytes);
}

Status check_fields(const Json& body, std::span<const std::string_view> names) {
  if (!body.is_object()) return fail_usage("it is not an object", {}, "send an object of JSON");
  for (const auto& [name, value] : body.items())
    if (std::ranges::find(names, name) == names.end())
      return fail_usage("there is no such field", name,
                        names.empty() ? "send an empty object" : fmt::format("send {}", fmt::join(names, ", ")));
  return {};
}

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json or_null(std::string_view text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

double rounded(double value) noexcept {
  constexpr double kThousand = 1000.0;
  return std::round(value * kThousand) / kThousand;
}

std::int64_t seconds_of(results::Seconds time) noexcept {
  return time.time_since_epoch().count();
}

}  // namespace trocar::web
