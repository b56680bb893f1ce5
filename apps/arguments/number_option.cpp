#include "number_option.h"

#include <fmt/format.h>

#include <string>

#include "core/parse_number.h"

namespace trocar::arguments {
namespace {

template <class Number>
struct Range {
  Number low, high;
  const char* kind;  ///< "number", "whole number".
  std::string unit;

  std::string text() const { return fmt::format("{} to {}{}{}", low, high, unit.empty() ? "" : " ", unit); }
  /// NaN is outside every range.
  bool holds(Number number) const { return number >= low && number <= high; }
};

/// Rejects values out of range; rewrites the number in a decimal form that CLI11 can read.
template <class Number>
CLI::Option* restrict_to(CLI::Option* option, Range<Number> range) {
  option->description(fmt::format("{} ({})", option->get_description(), range.text()));
  option->type_name("NUMBER");
  return option->transform(CLI::Validator(
      [range = std::move(range)](std::string& text) {
        const auto number = parse_number<Number>(text);
        if (!number || !range.holds(*number))
          return fmt::format("\"{}\" is not a {} from {}", text, range.kind, range.text());
        text = fmt::format("{}", *number);
        return std::string();
      },
      ""));
}

}  // namespace

CLI::Option* number_within(CLI::Option* option, double low, double high, std::string_view unit) {
  return restrict_to<double>(option, {low, high, "number", std::string(unit)});
}

CLI::Option* whole_number_within(CLI::Option* option, std::int64_t low, std::int64_t high) {
  return restrict_to<std::int64_t>(option, {low, high, "whole number", {}});
}

CLI::Option* seed_number(CLI::Option* option) {
  return restrict_to<std::uint64_t>(option, {0, std::numeric_limits<std::uint64_t>::max(), "whole number", {}});
}

}  // namespace trocar::arguments
