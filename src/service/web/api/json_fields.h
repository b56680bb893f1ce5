#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "config/json.h"
#include "results/repository.h"

namespace trocar::web {

using config::Json;

inline constexpr std::size_t kMostTextBytes = 4096;
/// A text of the body, of at most so many bytes of UTF-8. Error (exit status 2): missing, not a text, too long.
Result<std::string> text_field(const Json& body, const char* name, std::size_t most_bytes = kMostTextBytes);
/// The same, empty if it is missing or null.
Result<std::string> text_field_or_empty(const Json& body, const char* name, std::size_t most_bytes = kMostTextBytes);

/// Error (exit status 2): not an object, or a field of another name.
Status check_fields(const Json& body, std::span<const std::string_view> names);

/// A value, or null.
Json or_null(const std::optional<double>& value);
Json or_null(std::string_view text);  ///< Null if it is empty.
/// To three decimals: micrometres, millinewtons.
double rounded(double value) noexcept;
std::int64_t seconds_of(results::Seconds time) noexcept;

}  // namespace trocar::web
