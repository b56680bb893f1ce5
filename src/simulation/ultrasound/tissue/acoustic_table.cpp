#include "ultrasound/tissue/acoustic_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/toml.h"

namespace trocar::ultrasound {
namespace {

constexpr std::size_t kMostTissues = 127;  // AcousticScene stores them in seven bits

struct Field {
  std::string_view key;
  config::Range range;
  double AcousticTissue::*value;
};
constexpr Field kFields[] = {
    {"speed_m_per_s", {300.0, 4500.0}, &AcousticTissue::speed_m_per_s},
    {"density_kg_per_m3", {1.0, 2500.0}, &AcousticTissue::density_kg_per_m3},
    {"attenuation_db_per_cm_mhz", {0.0, 100.0}, &AcousticTissue::attenuation_db_per_cm_mhz},
    {"attenuation_exponent", {0.5, 2.0}, &AcousticTissue::attenuation_exponent},
    {"backscatter_db", {-80.0, 30.0}, &AcousticTissue::backscatter_db},
    {"scatterer_share", {0.0, 1.0}, &AcousticTissue::scatterer_share},
    {"texture_db_per_hu", {-1.0, 1.0}, &AcousticTissue::texture_db_per_hu},
    {"texture_below_db_per_hu", {-1.0, 1.0}, &AcousticTissue::texture_below_db_per_hu},
    {"roughness", {0.0, 1.0}, &AcousticTissue::roughness},
    {"fibre_db", {0.0, 20.0}, &AcousticTissue::fibre_db},
};

Result<AcousticTissue> read_tissue(const config::TomlTable& row, const std::string& name) {
  AcousticTissue tissue;
  tissue.name = name;
  std::vector<std::string_view> known;
  for (const Field& field : kFields) {
    TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, field.key, field.range));
    tissue.*field.value = number.value;
    known.push_back(field.key);
  }
  constexpr std::string_view kStrands = "strands_per_ml";  // most tissues have none
  known.push_back(kStrands);
  if (row.has(kStrands)) {
    TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, kStrands, {0.0, 20.0}));
    tissue.strands_per_ml = number.value;
  }
  TROCAR_TRY_STATUS(row.check_keys(known));
  return tissue;
}

/// Rows of the tissues of that names.
Result<std::vector<std::uint8_t>> read_tissues(const config::TomlTable& row, std::string_view key,
                                               const AcousticTable& table) {
  TROCAR_TRY(const std::vector<std::string> names, row.strings(key));
  if (names.empty()) return fail(fmt::format("the wall has no \"{}\"", key), row.where(), "name at least one tissue");
  std::vector<std::uint8_t> tissues;
  for (const std::string& name : names) {
    const auto tissue = table.find(name);
    if (!tissue)
      return fail(fmt::format("{} has the unknown tissue \"{}\"", key, name), row.where(),
                  "name a tissue of this file");
    tissues.push_back(*tissue);
  }
  return tissues;
}

Result<AcousticWall> read_wall(const config::TomlTable& row, const std::string& name, const AcousticTable& table) {
  AcousticWall wall;
  wall.name = name;
  TROCAR_TRY_STATUS(row.check_keys({"of", "against", "thickness_mm", "backscatter_db", "even_db"}));
  TROCAR_TRY(wall.of, read_tissues(row, "of", table));
  TROCAR_TRY(wall.against, read_tissues(row, "against", table));
  TROCAR_TRY(const config::SourcedNumber thickness, config::read_sourced_number(row, "thickness_mm", {0.1, 10.0}));
  TROCAR_TRY(const config::SourcedNumber backscatter,
             config::read_sourced_number(row, "backscatter_db", {-40.0, 40.0}));
  wall.thickness_mm = thickness.value;
  TROCAR_TRY(const config::SourcedNumber even, config::read_sourced_number(row, "even_db", {-80.0, 40.0}));
  wall.backscatter_db = backscatter.value;
  wall.even_db = even.value;
  return wall;
}

}  // namespace

double AcousticTissue::attenuation_db_per_cm(double frequency_mhz) const noexcept {
  return attenuation_db_per_cm_mhz * std::pow(frequency_mhz, attenuation_exponent);
}

double AcousticTissue::texture_db(double deviation_hu) const noexcept {
  const double db = deviation_hu * (deviation_hu > 0.0 ? texture_db_per_hu : texture_below_db_per_hu);
  return std::clamp(db, -kMostTexture_db, kMostTexture_db);
}

std::optional<std::uint8_t> AcousticTable::find(std::string_view name) const noexcept {
  const auto it = std::find_if(tissues.begin(), tissues.end(), [&](const AcousticTissue& t) { return t.name == name; });
  if (it == tissues.end()) return std::nullopt;
  return static_cast<std::uint8_t>(it - tissues.begin());
}

Result<AcousticTable> load_acoustic_table(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"tissues", "walls"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("tissues"));
  const std::vector<std::string> names = rows.keys();
  if (names.empty() || names.front() != "air")
    return fail("the first tissue must be air", rows.where(), "move air to the top of the table");
  if (names.size() > kMostTissues)
    return fail(fmt::format("{} tissues, at most {} fit", names.size(), kMostTissues), rows.where(), "remove tissues");
  AcousticTable table;
  for (const std::string& name : names) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(AcousticTissue tissue, read_tissue(row, name));
    table.tissues.push_back(std::move(tissue));
  }
  if (!document.has("walls")) return table;
  TROCAR_TRY(const config::TomlTable walls, document.table("walls"));
  for (const std::string& name : walls.keys()) {
    TROCAR_TRY(const config::TomlTable row, walls.table(name));
    TROCAR_TRY(AcousticWall wall, read_wall(row, name, table));
    table.walls.push_back(std::move(wall));
  }
  return table;
}

double reflection(double z1_mrayl, double z2_mrayl) noexcept {
  return (z2_mrayl - z1_mrayl) / (z2_mrayl + z1_mrayl);
}

}  // namespace trocar::ultrasound
