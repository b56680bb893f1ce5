#include "anatomy/tissue/tissue_setting.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/parse_number.h"

namespace trocar::anatomy {
namespace {

constexpr std::string_view kNever = "never";

}  // namespace

TissueSetting make_setting(std::string_view name, double value) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {{}, std::string(name), value};
  return {std::string(name.substr(0, dot)), std::string(name.substr(dot + 1)), value};
}

Result<TissueSetting> parse_setting(std::string_view text) {
  const auto malformed = [&] {
    return fail_usage("--set needs NAME.KEY=NUMBER (finite, or never)", std::string(text), "for example liver.k=0.5");
  };
  const std::size_t equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  if (equals == std::string_view::npos || name.find('.') == std::string_view::npos) return malformed();
  const std::string_view digits = text.substr(equals + 1);
  if (digits == kNever) return make_setting(name, std::numeric_limits<double>::infinity());
  const auto value = parse_number<double>(digits);
  if (!value) return malformed();
  return make_setting(name, *value);
}

std::string name_of(const TissueSetting& setting) {
  return fmt::format("{}.{}", setting.row, setting.key);
}

std::string to_string(const TissueSetting& setting) {
  // The shortest digits that read back to the same bits.
  return std::isinf(setting.value) ? fmt::format("{}={}", name_of(setting), kNever)
                                   : fmt::format("{}={}", name_of(setting), setting.value);
}

}  // namespace trocar::anatomy
