#include "xray/geometry/c_arm_presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "config/sourced_number.h"
#include "config/toml.h"

namespace trocar::xray {
namespace {

struct Field {
  std::string_view key;
  double* value;
  config::Range range;
};

Result<CArmPreset> read_preset(const std::string& name, const config::TomlTable& row) {
  CArmPreset preset;
  preset.name = name;
  TROCAR_TRY(preset.title, row.string("title"));
  const Field fields[] = {
      {"source_isocentre_mm", &preset.arm.source_isocentre_mm, {300.0, 1500.0}},
      {"source_detector_mm", &preset.arm.source_detector_mm, {400.0, 2000.0}},
      {"detector_mm", &preset.detector_mm, {0.1, 2.0}},
      {"aluminium_mm", &preset.aluminium_mm, {0.5, 20.0}},
      {"copper_mm", &preset.copper_mm, {0.0, 1.0}},
      {"kv", &preset.kv, {40.0, 150.0}},
      {"lao_deg", &preset.largest_lao_deg, {0.0, 180.0}},
      {"cranial_deg", &preset.largest_cranial_deg, {0.0, 90.0}},
  };
  std::vector<std::string_view> known{"title", "fields_mm", "fields_source", "pixels"};
  for (const Field& field : fields) {
    TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, field.key, field.range));
    *field.value = number.value;
    known.push_back(field.key);
  }
  TROCAR_TRY_STATUS(row.check_keys(known));
  TROCAR_TRY_STATUS(row.string("fields_source"));
  TROCAR_TRY(preset.fields_mm, row.numbers("fields_mm", {50.0, 500.0}));
  if (preset.fields_mm.empty() || !std::is_sorted(preset.fields_mm.rbegin(), preset.fields_mm.rend()))
    return fail("the fields of a C-arm do not fall", row.where(), "list fields_mm from the largest to the smallest");
  TROCAR_TRY(const std::int64_t pixels, row.integer("pixels", {16.0, 2048.0}));
  preset.arm.pixels = static_cast<int>(pixels);
  preset.arm.field_mm = preset.fields_mm.front();
  if (const Status status = check_c_arm(preset.arm); !status)
    return fail(status.error().what, row.where(), status.error().advice);
  return preset;
}

}  // namespace

Result<std::vector<CArmPreset>> load_c_arms(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"carms"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("carms"));
  std::vector<CArmPreset> presets;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(CArmPreset preset, read_preset(name, row));
    presets.push_back(std::move(preset));
  }
  if (presets.empty()) return fail("the file lists no C-arm", file.string(), "add a table [carms.NAME]");
  return presets;
}

Result<CArmPreset> load_c_arm(const std::filesystem::path& file, std::string_view name) {
  TROCAR_TRY(const std::vector<CArmPreset> presets, load_c_arms(file));
  const auto found = std::ranges::find(presets, name, &CArmPreset::name);
  if (found != presets.end()) return *found;
  std::vector<std::string> names;
  for (const CArmPreset& preset : presets) names.push_back(preset.name);
  return fail_usage(fmt::format("there is no C-arm \"{}\"", name), file.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

}  // namespace trocar::xray
