#include "anatomy/tissue/tissue_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "anatomy/tissue/tissue_fields.h"
#include "core/text.h"

namespace trocar::anatomy {
namespace {

constexpr std::string_view kViscosity = "nu";  // of layers and of tissues

/// A number of a table with the unique name used by apply_override.
struct NamedNumber {
  std::string setting;
  std::string path;  ///< Key of the table's provenance.
  double value = 0.0;
};

template <class T>
void append_numbers(std::vector<NamedNumber>& numbers, const std::vector<T>& rows,
                    std::span<const TissueField<T>> fields, std::string_view kind) {
  for (const T& row : rows) {
    for (const TissueField<T>& field : fields) {
      const std::string short_name = fmt::format("{}.{}", row.name, field.short_name);
      numbers.push_back({field.short_name == kViscosity ? fmt::format("{}.{}", kind, short_name) : short_name,
                         fmt::format("{}.{}.{}", kind, row.name, field.name), row.*field.member});
    }
  }
}

template <class T>
void append_section(std::vector<NamedNumber>& numbers, const T& section, std::span<const TissueField<T>> fields,
                    std::string_view name) {
  for (const TissueField<T>& field : fields)
    numbers.push_back(
        {fmt::format("{}.{}", name, field.short_name), fmt::format("{}.{}", name, field.name), section.*field.member});
}

std::vector<NamedNumber> numbers_of(const TissueTable& table) {
  std::vector<NamedNumber> numbers;
  append_numbers<LayerParams>(numbers, table.layers, kLayerFields, "layers");
  append_numbers<LayerParams>(numbers, table.layers, kOptionalLayerFields, "layers");
  for (const LayerParams& layer : table.layers)
    numbers.push_back({fmt::format("{}.{}", layer.name, kWall), fmt::format("layers.{}.{}", layer.name, kWall),
                       layer.is_wall ? 1.0 : 0.0});
  append_numbers<TissueParams>(numbers, table.tissues, kTissueFields, "tissues");
  const std::string thickness = fmt::format("skin.{}", kSkinThickness);
  numbers.push_back({thickness, thickness, table.skin_thickness_mm});
  append_section<FrictionLaw>(numbers, table.friction, kFrictionFields, kFriction);
  if (table.path_constraint.is_given)
    append_section<PathConstraintLaw>(numbers, table.path_constraint, kPathConstraintFields, kPathConstraint);
  for (const auto& field : kGradientFields) {
    const std::string setting = fmt::format("{}.{}", kTransfer, field.name);
    numbers.push_back({setting, setting, table.transfer.*field.member});
  }
  return numbers;
}

std::string setting_text(const NamedNumber& number) {
  if (std::isinf(number.value)) return number.setting + "=never";
  return fmt::format("{}={}", number.setting, number.value);
}

void append_curve_change(std::vector<std::string>& settings, const HuTransfer& from, const HuTransfer& to,
                         const TissueField<HuLaw>& field) {
  constexpr double kSameFactor = 1e-12;  // relative: the rounding of one multiplication
  std::optional<double> factor;
  bool is_one_factor = from.knot_count == to.knot_count;
  bool is_changed = !is_one_factor;
  for (std::size_t n = 0; n < std::min(from.knot_count, to.knot_count); ++n) {
    const double before = from.laws[n].*field.member, after = to.laws[n].*field.member;
    if (before == after && before == 0.0) continue;
    is_changed = is_changed || before != after;
    if (!factor) factor = after / before;
    is_one_factor = is_one_factor && std::abs(after - *factor * before) <= kSameFactor * std::abs(after);
  }
  if (!is_changed) return;
  settings.push_back(is_one_factor && factor
                         ? fmt::format("{}.{}{}={:.12g}", kTransfer, field.short_name, kFactorEnding, *factor)
                         : fmt::format("{}.{}=replaced", kTransfer, field.short_name));
}

}  // namespace

std::vector<std::string> user_settings(const TissueTable& table) {
  std::vector<std::string> settings;
  for (const NamedNumber& number : numbers_of(table)) {
    const auto found = table.provenance.find(number.path);
    if (found != table.provenance.end() && found->second.source == kOverrideSource)
      settings.push_back(setting_text(number));
  }
  for (const auto& field : kHuLawFields) {
    const auto found = table.provenance.find(fmt::format("{}.{}", kTransfer, field.name));
    if (found != table.provenance.end() && found->second.source == kOverrideSource)
      settings.push_back(fmt::format("{}.{}=replaced", kTransfer, field.short_name));
  }
  return settings;
}

std::vector<std::string> changed_settings(const TissueTable& from, const TissueTable& to) {
  const std::vector<NamedNumber> before = numbers_of(from), after = numbers_of(to);
  const auto is_same_name = [](const NamedNumber& a, const NamedNumber& b) { return a.setting == b.setting; };
  if (!std::ranges::equal(before, after, is_same_name)) return {"tissues=replaced"};
  std::vector<std::string> settings;
  for (std::size_t n = 0; n < after.size(); ++n)
    if (before[n].value != after[n].value) settings.push_back(setting_text(after[n]));
  for (const auto& field : kHuLawFields) append_curve_change(settings, from.transfer, to.transfer, field);
  return settings;
}

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
