#include "anatomy/derive/derive_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "anatomy/structure_pattern.h"

namespace trocar::anatomy {

namespace {

/// The one of kDerivable that a structure's name means, with or without a side; empty: none.
std::string_view derivable_of(std::string_view name) {
  const std::string plain = without_side(plain_name(name));
  const auto* const found =
      std::ranges::find_if(kDerivable, [&](std::string_view known) { return plain_name(known) == plain; });
  return found != std::end(kDerivable) ? *found : std::string_view{};
}

}  // namespace

bool is_derivable(std::string_view name) {
  return !derivable_of(name).empty();
}

DeriveChoice derivable_in(const LabelTable& table) {
  DeriveChoice choice{false, {}};
  for (const Label& label : table.labels) {
    const std::string_view name = derivable_of(label.name);
    if (!name.empty() && !choice.has(name)) choice.names.emplace_back(name);
  }
  return choice;
}

bool is_marked_derived(std::string_view name) {
  return name.starts_with(kDerivedMark) && is_derivable(name.substr(kDerivedMark.size()));
}

bool DeriveChoice::has(std::string_view name) const noexcept {
  return is_all || std::find(names.begin(), names.end(), name) != names.end();
}

Result<DeriveChoice> parse_derive_choice(std::string_view text) {
  if (text == "all") return DeriveChoice{};
  DeriveChoice choice{false, {}};
  if (text == "none") return choice;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    if (std::find(std::begin(kDerivable), std::end(kDerivable), name) == std::end(kDerivable))
      return fail_usage(fmt::format("\"{}\" is no structure that can be derived", name), std::string(text),
                        fmt::format("give all, none, or some of: {}", fmt::join(kDerivable, ",")));
    if (!choice.has(name)) choice.names.emplace_back(name);
    if (comma == std::string_view::npos) return choice;
    rest = rest.substr(comma + 1);
  }
}

}  // namespace trocar::anatomy
