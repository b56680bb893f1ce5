// The tissue table as text: overrides on the command line, and the text stored in a session.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "anatomy/tissue/tissue_fields.h"
#include "anatomy/tissue/tissue_settings.h"
#include "anatomy/tissue/tissue_table.h"

namespace trocar::anatomy {
namespace {

constexpr std::string_view kOfLayers = "layers.", kOfTissues = "tissues.";

template <class T>
void write_fields(config::TomlWriter& writer, const T& entry, std::span<const TissueField<T>> fields,
                  std::string_view kind, const std::map<std::string, Provenance>& provenance) {
  for (const TissueField<T>& field : fields)
    write_number(writer, field.name, entry.*field.member, fmt::format("{}.{}.{}", kind, entry.name, field.name),
                 provenance);
}

template <class T>
void write_section(config::TomlWriter& writer, std::string_view name, const T& section,
                   std::span<const TissueField<T>> fields, const std::map<std::string, Provenance>& provenance) {
  writer.begin_table({std::string(name)});
  for (const TissueField<T>& field : fields)
    write_number(writer, field.name, section.*field.member, fmt::format("{}.{}", name, field.name), provenance);
}

/// What an override names; `name` may hold dots.
struct Assignment {
  std::string_view name;
  std::string_view key;
  double value = 0.0;
};

Status check_range(const Assignment& assignment, std::string_view field, config::Range range, std::string_view text) {
  const bool is_never = std::isinf(assignment.value) && may_be_never(field);
  if (is_never || (assignment.value >= range.low && assignment.value <= range.high)) return {};
  const std::string named =
      assignment.key == field ? std::string(field) : fmt::format("{} ({})", assignment.key, field);
  return fail_usage(fmt::format("{} must be a number from {} to {}{}", named, range.low, range.high,
                                may_be_never(field) ? ", or never" : ""),
                    std::string(text), "give a number in this range");
}

const TissueField<LayerParams>* find_layer_field(std::string_view key) noexcept {
  const auto* field = find_field<LayerParams>(kLayerFields, key);
  return field ? field : find_field<LayerParams>(kOptionalLayerFields, key);
}

/// Sets the fields of an override.
class Override {
 public:
  Override(TissueTable& table, const Assignment& assignment, std::string_view text)
      : table_(table), assignment_(assignment), text_(text) {}

  Status apply() {
    if (assignment_.name == "skin" && (assignment_.key == kSkinThickness)) return set_skin_thickness();
    if (assignment_.name == kPathConstraint) {
      TROCAR_TRY_STATUS(set_number<PathConstraintLaw>(table_.path_constraint, kPathConstraintFields, "m0, n0"));
      table_.path_constraint.is_given = true;
      return {};
    }
    if (assignment_.name == kFriction)
      return set_number<FrictionLaw>(table_.friction, kFrictionFields, "tip, grows_to");
    if (assignment_.name == kTransfer)
      return assignment_.key.ends_with(kFactorEnding) ? scale_curve() : set_gradient_number();
    if (assignment_.name.starts_with(kOfLayers)) return set_row<LayerParams>(table_.layers, kLayerFields, kOfLayers);
    if (assignment_.name.starts_with(kOfTissues))
      return set_row<TissueParams>(table_.tissues, kTissueFields, kOfTissues);
    const auto tissue = table_.find_tissue(assignment_.name);
    const auto layer = table_.find_layer(assignment_.name);
    if (!tissue && !layer)
      return fail_usage(fmt::format("there is no tissue or layer \"{}\"", assignment_.name), std::string(text_),
                        fmt::format("known are: {}", fmt::join(known_names(), ", ")));
    if (tissue && *tissue == 0) return fail_usage("air has no parameters", std::string(text_), "name another tissue");
    if (layer && assignment_.key == kWall) return set_wall(table_.layers[*layer]);
    const auto* tissue_field = find_field<TissueParams>(kTissueFields, assignment_.key);
    const auto* layer_field = find_layer_field(assignment_.key);
    if (tissue && tissue_field) {
      TROCAR_TRY_STATUS(set(table_.tissues[*tissue], *tissue_field, "tissues"));
      const auto own_layer = table_.tissues[*tissue].layer;
      const bool is_shared_number = layer_field && own_layer && is_first_with_layer(*tissue);
      return is_shared_number ? set(table_.layers[*own_layer], *layer_field, "layers") : Status{};
    }
    const bool has_layer = layer || table_.tissues[*tissue].layer;
    if (!layer_field || !has_layer) return unknown_key(tissue.has_value(), has_layer);
    return set(table_.layers[layer ? *layer : *table_.tissues[*tissue].layer], *layer_field, "layers");
  }

 private:
  std::vector<std::string> known_names() const {
    std::vector<std::string> names{std::string(kFriction), std::string(kPathConstraint), std::string(kTransfer)};
    for (std::size_t n = 1; n < table_.tissues.size(); ++n) names.push_back(table_.tissues[n].name);
    for (const LayerParams& layer : table_.layers)
      if (!table_.find_tissue(layer.name)) names.push_back(layer.name);
    return names;
  }

  bool is_first_with_layer(std::uint8_t tissue) const {
    for (std::uint8_t n = 0; n < tissue; ++n)
      if (table_.tissues[n].layer == table_.tissues[tissue].layer) return false;
    return true;
  }

  template <class T>
  Status set(T& entry, const TissueField<T>& field, std::string_view kind) {
    TROCAR_TRY_STATUS(check_range(assignment_, field.name, field.range, text_));
    entry.*field.member = assignment_.value;
    table_.provenance[fmt::format("{}.{}.{}", kind, entry.name, field.name)] = {std::string(kOverrideSource), {}, {}};
    return {};
  }

  /// tissues.NAME.KEY, layers.NAME.KEY: only that row. `kind` includes its dot.
  template <class T>
  Status set_row(std::vector<T>& rows, std::span<const TissueField<T>> fields, std::string_view kind) {
    const std::string_view name = assignment_.name.substr(kind.size());
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const T& entry) { return entry.name == name; });
    if (row == rows.end() || name == table_.tissues.front().name)
      return fail_usage(fmt::format("there is no \"{}\"", assignment_.name), std::string(text_),
                        "use a row of the tissue table");
    const TissueField<T>* field = find_field<T>(fields, assignment_.key);
    if constexpr (std::is_same_v<T, LayerParams>) field = find_layer_field(assignment_.key);
    if (!field)
      return fail_usage(fmt::format("\"{}\" has no \"{}\"", assignment_.name, assignment_.key), std::string(text_),
                        "use a column of this row");
    return set(*row, *field, kind.substr(0, kind.size() - 1));
  }

  Status set_skin_thickness() {
    TROCAR_TRY_STATUS(check_range(assignment_, kSkinThickness, kSkinThicknessRange, text_));
    table_.skin_thickness_mm = assignment_.value;
    table_.provenance["skin.thickness_mm"] = {std::string(kOverrideSource), {}, {}};
    return {};
  }

  /// A number of a section that is not a row of a tissue or layer.
  template <class T>
  Status set_number(T& section, std::span<const TissueField<T>> fields, std::string_view known) {
    const TissueField<T>* field = find_field<T>(fields, assignment_.key);
    if (!field)
      return fail_usage(fmt::format("{} has no \"{}\"", assignment_.name, assignment_.key), std::string(text_),
                        fmt::format("known are: {}", known));
    TROCAR_TRY_STATUS(check_range(assignment_, field->name, field->range, text_));
    section.*field->member = assignment_.value;
    table_.provenance[fmt::format("{}.{}", assignment_.name, field->name)] = {std::string(kOverrideSource), {}, {}};
    return {};
  }

  Status set_gradient_number() {
    const auto* field = find_field<HuTransfer>(kGradientFields, assignment_.key);
    if (!field)
      return fail_usage(fmt::format("{} has no \"{}\" that can be set", kTransfer, assignment_.key), std::string(text_),
                        "known are: gradient_scale_mm, gradient_none_hu_per_mm, gradient_full_hu_per_mm");
    if (table_.transfer.knot_count == 0)
      return fail_usage("the tissue table has no transfer functions", std::string(text_),
                        "use a tissue table with [transfer]");
    TROCAR_TRY_STATUS(check_range(assignment_, field->name, field->range, text_));
    HuTransfer changed = table_.transfer;
    changed.*field->member = assignment_.value;
    if (!(changed.gradient_full_hu_per_mm > changed.gradient_none_hu_per_mm))
      return fail_usage("gradient_full_hu_per_mm must be above gradient_none_hu_per_mm", std::string(text_),
                        "raise gradient_full_hu_per_mm or lower the other");
    table_.transfer = changed;
    table_.provenance[fmt::format("{}.{}", kTransfer, field->name)] = {std::string(kOverrideSource), {}, {}};
    return {};
  }

  Status scale_curve() {
    const std::string_view key = assignment_.key.substr(0, assignment_.key.size() - kFactorEnding.size());
    const auto* field = find_field<HuLaw>(kHuLawFields, key);
    if (!field)
      return fail_usage(fmt::format("{} has no curve \"{}\"", kTransfer, key), std::string(text_),
                        "known are: k, tn, tt, r0, c, shaft, nu, young, each with _factor behind it");
    if (table_.transfer.knot_count == 0)
      return fail_usage("the tissue table has no transfer functions", std::string(text_),
                        "use a tissue table with [transfer]");
    TROCAR_TRY_STATUS(check_range(assignment_, assignment_.key, kCurveFactorRange, text_));
    for (std::size_t n = 0; n < table_.transfer.knot_count; ++n) {
      double& value = table_.transfer.laws[n].*field->member;
      value = std::clamp(value * assignment_.value, field->range.low, field->range.high);
    }
    table_.provenance[fmt::format("{}.{}", kTransfer, field->name)] = {std::string(kOverrideSource), {}, {}};
    return {};
  }

  Status set_wall(LayerParams& layer) {
    if (assignment_.value != 0.0 && assignment_.value != 1.0)
      return fail_usage("wall must be 0 or 1", std::string(text_), "give 0 (no) or 1 (yes)");
    layer.is_wall = assignment_.value == 1.0;
    return {};
  }

  /// A tissue without a layer has no stiffness and no puncture force.
  Status unknown_key(bool is_tissue, bool has_layer) const {
    std::vector<std::string_view> known;
    if (is_tissue)
      for (const auto& field : kTissueFields) known.push_back(field.short_name);
    if (has_layer)
      for (const auto& field : kLayerFields)
        if (std::find(known.begin(), known.end(), field.short_name) == known.end()) known.push_back(field.short_name);
    return fail_usage(fmt::format("\"{}\" has no \"{}\"", assignment_.name, assignment_.key), std::string(text_),
                      fmt::format("known are: {}", fmt::join(known, ", ")));
  }

  TissueTable& table_;
  const Assignment& assignment_;
  std::string_view text_;
};

}  // namespace

Provenance find_provenance(const std::map<std::string, Provenance>& provenance, const std::string& path) {
  const auto it = provenance.find(path);
  return it != provenance.end() ? it->second : Provenance{std::string(kOverrideSource), {}, {}};
}

void write_number(config::TomlWriter& writer, std::string_view key, double value, const std::string& path,
                  const std::map<std::string, Provenance>& provenance) {
  using Entry = config::TomlValue::Entry;
  const Provenance source = find_provenance(provenance, path);
  std::vector<Entry> number{std::isinf(value) ? Entry{"never", true} : Entry{"value", value},
                            {"source", source.source}};
  if (source.low && source.high) number.push_back({"range", std::vector<double>{*source.low, *source.high}});
  writer.set(key, number);
}

std::string TissueTable::to_toml() const {
  config::TomlWriter writer;
  writer.set("applied_profile", profile);
  if (!origin.empty()) writer.set(kOrigin, origin);
  writer.begin_table({"skin"});
  write_number(writer, kSkinThickness, skin_thickness_mm, "skin.thickness_mm", provenance);
  for (const LayerParams& layer : layers) {
    writer.begin_table({"layers", layer.name});
    if (layer.is_wall) writer.set(kWall, true);
    write_fields<LayerParams>(writer, layer, kLayerFields, "layers", provenance);
    for (const auto& field : kOptionalLayerFields) {
      if (layer.*field.member == 0.0) continue;
      write_number(writer, field.name, layer.*field.member, fmt::format("layers.{}.{}", layer.name, field.name),
                   provenance);
    }
  }
  for (std::size_t n = 1; n < tissues.size(); ++n) {
    const TissueParams& tissue = tissues[n];
    writer.begin_table({"tissues", tissue.name});
    if (tissue.layer) writer.set("layer", layers[*tissue.layer].name);
    write_fields<TissueParams>(writer, tissue, kTissueFields, "tissues", provenance);
  }
  write_hu_transfer(writer, *this);
  if (needle_size.diameter_mm > 0.0) {
    write_section<NeedleSizeLaw>(writer, kNeedleSize, needle_size, kNeedleSizeFields, provenance);
    if (needle_size.bevel_power > 0.0)
      write_number(writer, "bevel_power", needle_size.bevel_power, "needle_size.bevel_power", provenance);
  }
  write_section<FrictionLaw>(writer, kFriction, friction, kFrictionFields, provenance);
  if (path_constraint.is_given)
    write_section<PathConstraintLaw>(writer, kPathConstraint, path_constraint, kPathConstraintFields, provenance);
  return writer.text();
}

Status apply_setting(TissueTable& table, const TissueSetting& setting) {
  const std::string text = to_string(setting);
  const Assignment assignment{setting.row, setting.key, setting.value};
  return Override(table, assignment, text).apply();
}

Status apply_override(TissueTable& table, std::string_view assignment) {
  TROCAR_TRY(const TissueSetting setting, parse_setting(assignment));
  return apply_setting(table, setting);
}

}  // namespace trocar::anatomy
