#include "ultrasound/scanner/scan_preset.h"

#include <utility>

#include "config/toml.h"

namespace trocar::ultrasound {
namespace {

Status read_if_given(const config::TomlTable& row, std::string_view key, config::Range range,
                     std::optional<double>& value) {
  if (!row.has(key)) return {};
  TROCAR_TRY(value, row.number(key, range));
  return {};
}

Result<ScanPreset> read_preset(const config::TomlTable& row, const std::string& name) {
  TROCAR_TRY_STATUS(
      row.check_keys({"title", "transducer", "depth_mm", "frequency_mhz", "focus_mm", "gain_db", "dynamic_range_db",
                      "gray_map", "persistence", "has_doppler", "doppler_scale_cm_per_s"}));
  ScanPreset preset;
  preset.name = name;
  TROCAR_TRY(preset.title, row.string("title"));
  TROCAR_TRY(preset.transducer, row.string("transducer"));
  TROCAR_TRY_STATUS(read_if_given(row, "depth_mm", {20.0, 300.0}, preset.depth_mm));
  TROCAR_TRY_STATUS(read_if_given(row, "frequency_mhz", {1.0, 20.0}, preset.frequency_mhz));
  TROCAR_TRY_STATUS(read_if_given(row, "focus_mm", {5.0, 300.0}, preset.focus_mm));
  DisplaySettings& display = preset.display;
  TROCAR_TRY(display.gain_db, row.number_or("gain_db", {-40.0, 40.0}, display.gain_db));
  TROCAR_TRY(display.dynamic_range_db, row.number_or("dynamic_range_db", {20.0, 100.0}, display.dynamic_range_db));
  TROCAR_TRY(display.persistence, row.number_or("persistence", {0.0, 0.95}, display.persistence));
  TROCAR_TRY(const std::string map, row.string_or("gray_map", std::string(name_of(display.gray_map))));
  const Result<GrayMap> gray_map = parse_gray_map(map);
  if (!gray_map) return fail("there is no gray map \"" + map + "\"", row.where(), "use linear, soft or high-contrast");
  display.gray_map = *gray_map;
  TROCAR_TRY(preset.has_doppler, row.boolean_or("has_doppler", false));
  TROCAR_TRY(preset.doppler_scale_cm_per_s,
             row.number_or("doppler_scale_cm_per_s", {2.0, 200.0}, preset.doppler_scale_cm_per_s));
  return preset;
}

}  // namespace

Result<std::vector<ScanPreset>> load_scan_presets(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"presets"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("presets"));
  std::vector<ScanPreset> presets;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(ScanPreset preset, read_preset(row, name));
    presets.push_back(std::move(preset));
  }
  return presets;
}

Acquisition acquisition_of(const ScanPreset& preset, const Transducer& transducer) {
  Acquisition acquisition = default_acquisition(transducer);
  acquisition.depth_mm = preset.depth_mm.value_or(acquisition.depth_mm);
  acquisition.frequency_mhz = preset.frequency_mhz.value_or(acquisition.frequency_mhz);
  acquisition.focus_mm = preset.focus_mm.value_or(acquisition.focus_mm);
  return acquisition;
}

}  // namespace trocar::ultrasound
