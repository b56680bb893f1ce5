#include "anatomy/tissue/tissue_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "anatomy/tissue/tissue_fields.h"
#include "config/toml.h"
#include "core/files/output_file.h"

namespace trocar::anatomy {
namespace {

constexpr config::Range kUnknownYoung{1.0, 1000.0};
constexpr std::size_t kMaxEntries = 250;  ///< Tissues and layers are numbered with one byte.

template <class T>
std::optional<std::uint8_t> find_named(const std::vector<T>& entries, std::string_view name) noexcept {
  const auto it = std::find_if(entries.begin(), entries.end(), [&](const T& entry) { return entry.name == name; });
  if (it == entries.end()) return std::nullopt;
  return static_cast<std::uint8_t>(it - entries.begin());
}

/// Reads one number with its source into `value` and the table's provenance under `path`.
Status read_number(const config::TomlTable& row, std::string_view key, config::Range allowed, const std::string& path,
                   double& value, TissueTable& table) {
  TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, key, allowed));
  value = number.value;
  Provenance provenance{number.source, {}, {}};
  if (number.range) {
    provenance.low = number.range->low;
    provenance.high = number.range->high;
  }
  table.provenance[path] = std::move(provenance);
  return {};
}

/// puncture_force_n = {never = true, source = "…"}; empty if the entry is an ordinary number.
Result<std::optional<std::string>> read_never(const config::TomlTable& row, std::string_view key) {
  const auto entry = row.table(key);
  if (!entry || !entry->has("never")) return std::optional<std::string>();
  TROCAR_TRY_STATUS(entry->check_keys({"never", "source"}));
  TROCAR_TRY(const bool never, entry->boolean_or("never", false));
  TROCAR_TRY(std::string source, entry->string("source"));
  if (!never) return fail("never must be true", entry->where(), "give a value instead");
  return std::optional(std::move(source));
}

/// Reads the fields of a row; in a profile only the present ones.
template <class T>
Status read_fields(const config::TomlTable& row, std::span<const TissueField<T>> fields, const std::string& path,
                   bool are_required, T& entry, TissueTable& table) {
  for (const TissueField<T>& field : fields) {
    if (!are_required && !row.has(field.name)) continue;
    const std::string field_path = fmt::format("{}.{}", path, field.name);
    if (may_be_never(field.name)) {
      TROCAR_TRY(const std::optional<std::string> never, read_never(row, field.name));
      if (never) {
        entry.*field.member = std::numeric_limits<double>::infinity();
        table.provenance[field_path] = {*never, {}, {}};
        continue;
      }
    }
    TROCAR_TRY_STATUS(read_number(row, field.name, field.range, field_path, entry.*field.member, table));
  }
  return {};
}

template <class T>
std::vector<std::string_view> field_names(std::span<const TissueField<T>> fields) {
  std::vector<std::string_view> names;
  for (const auto& field : fields) names.push_back(field.name);
  return names;
}

/// The required fields of a tissue. Sessions stored before tissues had a Young's modulus can still be loaded: missing
/// fields get the default, with a corresponding source.
std::span<const TissueField<TissueParams>> required_fields(const config::TomlTable& row, bool is_stored,
                                                           const std::string& path, TissueTable& table) {
  const std::span<const TissueField<TissueParams>> fields = kTissueFields;
  static_assert(kTissueFields.back().name == kYoung);
  if (!is_stored || row.has(kYoung)) return fields;
  table.provenance[fmt::format("{}.{}", path, kYoung)] = {"assumed, stored without it", kUnknownYoung.low,
                                                          kUnknownYoung.high};
  return fields.first(fields.size() - 1);
}

Status read_layers(const config::TomlTable& document, TissueTable& table) {
  TROCAR_TRY(const config::TomlTable rows, document.table("layers"));
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    std::vector<std::string_view> known = field_names<LayerParams>(kLayerFields);
    known.push_back(kWall);
    for (const auto& field : kOptionalLayerFields) known.push_back(field.name);
    TROCAR_TRY_STATUS(row.check_keys(known));
    LayerParams layer;
    layer.name = name;
    TROCAR_TRY(layer.is_wall, row.boolean_or(kWall, false));
    TROCAR_TRY_STATUS(read_fields<LayerParams>(row, kLayerFields, "layers." + name, true, layer, table));
    TROCAR_TRY_STATUS(read_fields<LayerParams>(row, kOptionalLayerFields, "layers." + name, false, layer, table));
    table.layers.push_back(std::move(layer));
  }
  return {};
}

Status read_tissues(const config::TomlTable& document, TissueTable& table) {
  TissueParams air;
  air.name = "air";
  table.tissues.push_back(std::move(air));
  TROCAR_TRY(const config::TomlTable rows, document.table("tissues"));
  std::vector<std::string_view> known = field_names<TissueParams>(kTissueFields);
  known.push_back("layer");
  const bool is_stored = document.has("applied_profile");
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    if (name == "air") return fail("air is built in and has no force", row.where(), "remove it");
    TROCAR_TRY_STATUS(row.check_keys(known));
    TissueParams tissue;
    tissue.name = name;
    const auto fields = required_fields(row, is_stored, "tissues." + name, table);
    TROCAR_TRY_STATUS(read_fields<TissueParams>(row, fields, "tissues." + name, true, tissue, table));
    if (row.has("layer")) {
      TROCAR_TRY(const std::string layer, row.string("layer"));
      tissue.layer = table.find_layer(layer);
      if (!tissue.layer) return fail(fmt::format("there is no layer \"{}\"", layer), row.where(), "add [layers.NAME]");
    }
    table.tissues.push_back(std::move(tissue));
  }
  return {};
}

/// The changes of one profile on the entries of one kind ("layers" or "tissues").
template <class T>
Status apply_profile_part(const config::TomlTable& profile, std::string_view kind,
                          std::span<const TissueField<T>> fields, std::vector<T>& entries, TissueTable& table) {
  if (!profile.has(kind)) return {};
  TROCAR_TRY(const config::TomlTable rows, profile.table(kind));
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY_STATUS(row.check_keys(field_names<T>(fields)));
    const auto index = find_named(entries, name);
    if (!index)
      return fail(fmt::format("changes {}.{}, which is not in the table", kind, name), row.where(),
                  "remove the row, or correct its name");
    TROCAR_TRY_STATUS(read_fields<T>(row, fields, fmt::format("{}.{}", kind, name), false, entries[*index], table));
  }
  return {};
}

Status apply_profile(const config::TomlTable& document, std::string_view wanted, TissueTable& table) {
  TROCAR_TRY(const std::string applied, document.string_or("applied_profile", ""));
  if (!applied.empty()) {
    if (!wanted.empty() && wanted != applied)
      return fail_usage(fmt::format("the table was stored with the profile \"{}\", not \"{}\"", applied, wanted),
                        document.where(), "omit the profile");
    table.profile = applied;
    return {};
  }
  table.profile = wanted.empty() ? kDefaultProfile : wanted;
  TROCAR_TRY(const config::TomlTable profiles, document.table("profiles"));
  if (!profiles.has(table.profile))
    return fail_usage(fmt::format("unknown tissue profile \"{}\"", table.profile), document.where(),
                      fmt::format("known are: {}", fmt::join(profiles.keys(), ", ")));
  TROCAR_TRY(const config::TomlTable profile, profiles.table(table.profile));
  TROCAR_TRY_STATUS(profile.check_keys({"description", "layers", "tissues"}));
  TROCAR_TRY_STATUS(apply_profile_part<LayerParams>(profile, "layers", kLayerFields, table.layers, table));
  return apply_profile_part<TissueParams>(profile, "tissues", kTissueFields, table.tissues, table);
}

/// Tables stored before there was such a law keep their forces for every needle.
Status read_needle_size(const config::TomlTable& document, TissueTable& table) {
  if (!document.has(kNeedleSize)) return {};
  TROCAR_TRY(const config::TomlTable row, document.table(kNeedleSize));
  std::vector<std::string_view> known = field_names<NeedleSizeLaw>(kNeedleSizeFields);
  for (const auto& field : kOptionalNeedleSizeFields) known.push_back(field.name);
  TROCAR_TRY_STATUS(row.check_keys(known));
  const std::string name(kNeedleSize);
  TROCAR_TRY_STATUS(read_fields<NeedleSizeLaw>(row, kNeedleSizeFields, name, true, table.needle_size, table));
  TROCAR_TRY_STATUS(read_fields<NeedleSizeLaw>(row, kOptionalNeedleSizeFields, name, false, table.needle_size, table));
  if (table.needle_size.tearing + table.needle_size.spreading > 0.0) return {};
  return fail("tearing and spreading are both zero", row.where(), "give at least one of them a share");
}

/// Tables stored before there was such a section keep the friction that they had.
Status read_friction(const config::TomlTable& document, TissueTable& table) {
  if (!document.has(kFriction)) return {};
  TROCAR_TRY(const config::TomlTable row, document.table(kFriction));
  TROCAR_TRY_STATUS(row.check_keys(field_names<FrictionLaw>(kFrictionFields)));
  return read_fields<FrictionLaw>(row, kFrictionFields, std::string(kFriction), true, table.friction, table);
}

/// Only tables that were fitted to a patient have it, and those in which the user chose it.
Status read_path_constraint(const config::TomlTable& document, TissueTable& table) {
  if (!document.has(kPathConstraint)) return {};
  TROCAR_TRY(const config::TomlTable row, document.table(kPathConstraint));
  TROCAR_TRY_STATUS(row.check_keys(field_names<PathConstraintLaw>(kPathConstraintFields)));
  table.path_constraint.is_given = true;
  return read_fields<PathConstraintLaw>(row, kPathConstraintFields, std::string(kPathConstraint), true,
                                        table.path_constraint, table);
}

Status read_origin(const config::TomlTable& document, TissueTable& table) {
  TROCAR_TRY(table.origin, document.string_or(kOrigin, ""));
  if (table.origin.size() <= kLongestOrigin) return {};
  return fail(fmt::format("origin has more than {} characters", kLongestOrigin), document.where(), "shorten it");
}

Result<TissueTable> read_table(const config::TomlTable& document, std::string_view profile) {
  TROCAR_TRY_STATUS(document.check_keys({"skin", "layers", "tissues", "profiles", "applied_profile", kTransfer,
                                         kNeedleSize, kPathConstraint, kFriction, kOrigin}));
  TissueTable table;
  TROCAR_TRY(const config::TomlTable skin, document.table("skin"));
  TROCAR_TRY_STATUS(skin.check_keys({kSkinThickness}));
  TROCAR_TRY_STATUS(
      read_number(skin, kSkinThickness, kSkinThicknessRange, "skin.thickness_mm", table.skin_thickness_mm, table));
  TROCAR_TRY_STATUS(read_layers(document, table));
  TROCAR_TRY_STATUS(read_tissues(document, table));
  if (table.layers.size() > kMaxEntries || table.tissues.size() > kMaxEntries)
    return fail(fmt::format("more than {} tissues or layers", kMaxEntries), document.where(), "remove rows");
  const auto skin_index = table.find_tissue("skin");
  if (!skin_index || !table.tissues[*skin_index].layer)
    return fail("a tissue \"skin\" with a layer is needed", document.where(), "add [tissues.skin]");
  table.skin = *skin_index;
  TROCAR_TRY_STATUS(read_hu_transfer(document, table));
  TROCAR_TRY_STATUS(read_needle_size(document, table));
  TROCAR_TRY_STATUS(read_path_constraint(document, table));
  TROCAR_TRY_STATUS(read_friction(document, table));
  TROCAR_TRY_STATUS(read_origin(document, table));
  TROCAR_TRY_STATUS(apply_profile(document, profile, table));
  return table;
}

}  // namespace

std::optional<std::uint8_t> TissueTable::find_tissue(std::string_view name) const noexcept {
  return find_named(tissues, name);
}

std::optional<std::uint8_t> TissueTable::find_layer(std::string_view name) const noexcept {
  return find_named(layers, name);
}

Result<TissueTable> parse_tissue_table(std::string_view toml_text, const std::string& name, std::string_view profile) {
  TROCAR_TRY(const config::TomlTable document, config::parse_toml(toml_text, name));
  return read_table(document, profile);
}

Result<TissueTable> load_tissue_table(const std::filesystem::path& path, std::string_view profile) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  return read_table(document, profile);
}

Result<std::vector<std::string>> tissue_profiles(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  if (document.has("applied_profile")) {
    TROCAR_TRY(std::string applied, document.string("applied_profile"));
    return std::vector<std::string>{std::move(applied)};
  }
  TROCAR_TRY(const config::TomlTable profiles, document.table("profiles"));
  return profiles.keys();
}

namespace {

HuLaw mix(const HuLaw& a, const HuLaw& b, double t) noexcept {
  const auto lerp = [t](double x, double y) { return x + t * (y - x); };
  return {lerp(a.stiffness_n_per_mm, b.stiffness_n_per_mm),
          lerp(a.normal_n, b.normal_n),
          lerp(a.tangential_n, b.tangential_n),
          lerp(a.resistance_n, b.resistance_n),
          lerp(a.viscosity_ns_per_mm, b.viscosity_ns_per_mm),
          lerp(a.shaft_n_per_mm, b.shaft_n_per_mm),
          lerp(a.shaft_viscosity_ns_per_mm, b.shaft_viscosity_ns_per_mm),
          lerp(a.young_kpa, b.young_kpa)};
}

}  // namespace

HuLaw HuTransfer::at(double hu_value) const noexcept {
  if (knot_count == 0) return {};
  if (!(hu_value > hu[0])) return laws[0];
  for (std::size_t i = 1; i < knot_count; ++i) {
    if (hu_value < hu[i]) return mix(laws[i - 1], laws[i], (hu_value - hu[i - 1]) / (hu[i] - hu[i - 1]));
  }
  return laws[knot_count - 1];
}

}  // namespace trocar::anatomy
