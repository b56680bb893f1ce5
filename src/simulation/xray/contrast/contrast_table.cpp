#include "xray/contrast/contrast_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "config/toml.h"

namespace trocar::xray {
namespace {

constexpr std::string_view kOther = "other";

struct Number {
  std::string_view key;
  config::Range range;
  double* to;
};

Status read_numbers(const config::TomlTable& row, const std::vector<Number>& numbers) {
  for (const Number& number : numbers) {
    TROCAR_TRY(const config::SourcedNumber read, config::read_sourced_number(row, number.key, number.range));
    *number.to = read.value;
  }
  return {};
}

/// The section has these keys only.
Status read_section(const config::TomlTable& document, std::string_view name, const std::vector<Number>& numbers) {
  TROCAR_TRY(const config::TomlTable row, document.table(name));
  std::vector<std::string_view> keys;
  for (const Number& number : numbers) keys.push_back(number.key);
  TROCAR_TRY_STATUS(row.check_keys(keys));
  return read_numbers(row, numbers);
}

std::optional<ContrastPlace> place_named(std::string_view word) {
  if (word == "parenchyma") return ContrastPlace::kParenchyma;
  if (word == "fluid") return ContrastPlace::kFluid;
  if (word == "bowel") return ContrastPlace::kBowel;
  if (word == "tissue") return ContrastPlace::kTissue;
  return std::nullopt;
}

Result<ContrastMedium> read_medium(const config::TomlTable& row, bool has_tissues) {
  ContrastMedium medium;
  TROCAR_TRY(const std::string word, row.string("place"));
  const std::optional<ContrastPlace> place = place_named(word);
  if (!place) return fail(fmt::format("place is \"{}\"", word), row.where(), "use parenchyma, fluid, bowel or tissue");
  medium.place = *place;
  const bool is_fluid = *place == ContrastPlace::kFluid || *place == ContrastPlace::kBowel;
  std::vector<std::string_view> keys{"place"};
  std::vector<Number> numbers;
  if (is_fluid) {
    numbers = {{"mixing_mm2_per_s", {0.01, 200.0}, &medium.mixing_mm2_per_s}};
  } else {
    numbers = {{"space", {0.01, 1.0}, &medium.space},
               {"fade_s", {0.0, 1e5}, &medium.fade_s},
               {"heterogeneity", {0.0, 2.0}, &medium.heterogeneity},
               {"correlation_mm", {2.0, 20.0}, &medium.correlation_mm}};
  }
  for (const Number& number : numbers) keys.push_back(number.key);
  if (has_tissues) keys.emplace_back("tissues");
  TROCAR_TRY_STATUS(row.check_keys(keys));
  TROCAR_TRY_STATUS(read_numbers(row, numbers));
  TROCAR_TRY(medium.tissues, row.strings("tissues"));
  if (has_tissues && medium.tissues.empty()) return fail("no tissues", row.where(), "add tissues = [...]");
  return medium;
}

Status read_media(const config::TomlTable& document, ContrastTable& table) {
  TROCAR_TRY(const config::TomlTable media, document.table("media"));
  if (!media.has(kOther)) return fail("no medium \"other\"", media.where(), "add [media.other]");
  std::set<std::string> seen;
  const std::vector<std::string> names = media.keys();
  for (const std::string& name : names) {
    TROCAR_TRY(const config::TomlTable row, media.table(name));
    TROCAR_TRY(ContrastMedium medium, read_medium(row, name != kOther));
    for (const std::string& tissue : medium.tissues)
      if (!seen.insert(tissue).second)
        return fail(fmt::format("the tissue \"{}\" is in two media", tissue), row.where(), "keep it in one of them");
    if (name == kOther) {
      table.media.push_back(std::move(medium));
    } else {
      table.media.insert(table.media.begin(), std::move(medium));
    }
  }
  return {};
}

}  // namespace

std::string contrast_place_words(ContrastPlace place) {
  switch (place) {
    case ContrastPlace::kOutside:
      return "outside";
    case ContrastPlace::kDuct:
      return "bile duct";
    case ContrastPlace::kVessel:
      return "vessel";
    case ContrastPlace::kParenchyma:
      return "parenchyma";
    case ContrastPlace::kFluid:
      return "fluid";
    case ContrastPlace::kBowel:
      return "bowel";
    case ContrastPlace::kTissue:
      return "tissue";
  }
  return "outside";
}

std::size_t ContrastTable::medium_of(const std::string& tissue) const {
  for (std::size_t n = 0; n < media.size(); ++n)
    if (std::find(media[n].tissues.begin(), media[n].tissues.end(), tissue) != media[n].tissues.end()) return n;
  return media.size() - 1;
}

Result<ContrastTable> load_contrast_table(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"agent", "duct", "vessel", "media"}));
  ContrastTable table;
  TROCAR_TRY_STATUS(read_section(document, "agent", {{"iodine_mg_per_ml", {1.0, 500.0}, &table.iodine_mg_per_ml}}));
  DuctParams& duct = table.duct;
  TROCAR_TRY_STATUS(read_section(document, "duct",
                                 {{"dispersivity_mm", {0.0, 10.0}, &duct.dispersivity_mm},
                                  {"mixing_mm2_per_s", {0.0, 10.0}, &duct.mixing_mm2_per_s},
                                  {"papilla_share", {0.0, 0.9}, &duct.papilla_share},
                                  {"drain_s", {10.0, 1e5}, &duct.drain_s},
                                  {"distension", {0.0, 1.0}, &duct.distension},
                                  {"bridge_mm", {0.0, 20.0}, &duct.bridge_mm}}));
  VesselParams& vessel = table.vessel;
  TROCAR_TRY_STATUS(read_section(document, "vessel",
                                 {{"washout_s", {0.05, 5.0}, &vessel.washout_s},
                                  {"longest_s", {0.1, 10.0}, &vessel.longest_s},
                                  {"fan_slope", {0.02, 1.0}, &vessel.fan_slope}}));
  TROCAR_TRY_STATUS(read_media(document, table));
  return table;
}

}  // namespace trocar::xray
