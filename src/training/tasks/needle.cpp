#include "tasks/needle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include "config/toml.h"

namespace trocar::tasks {
namespace {

constexpr std::array<std::string_view, 5> kUses{"biopsy", "aspiration", "spinal", "epidural", "ascites"};
constexpr std::array<std::string_view, 5> kModels{"chiba", "tuohy", "quincke", "biopsy-gun", "trocar"};
constexpr double kThinnestWall = 0.95;  ///< Maximum bore as a share of the outer diameter.

Status read_value(const config::TomlTable& row, std::string_view key, config::Range range, double& value) {
  TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, key, range));
  value = number.value;
  return {};
}

Status read_word(const config::TomlTable& row, std::string_view key, std::span<const std::string_view> known,
                 std::string& word) {
  TROCAR_TRY(word, row.string(key));
  if (std::find(known.begin(), known.end(), word) != known.end()) return {};
  return fail(fmt::format("unknown {} \"{}\"", key, word), row.where(),
              fmt::format("known are: {}", fmt::join(known, ", ")));
}

Result<Needle> read_needle(const config::TomlTable& row, const std::string& name) {
  Needle needle;
  needle.name = name;
  TROCAR_TRY(needle.title, row.string("title"));
  TROCAR_TRY_STATUS(read_word(row, "use", kUses, needle.use));
  TROCAR_TRY_STATUS(read_word(row, "model", kModels, needle.model));
  TROCAR_TRY(needle.gauge, row.number("gauge", {7.0, 34.0}));
  TROCAR_TRY(needle.is_biopsy, row.boolean_or("is_biopsy", false));
  std::vector<std::string_view> known = {"title",
                                         "use",
                                         "model",
                                         "gauge",
                                         "is_biopsy",
                                         "outer_diameter_mm",
                                         "inner_diameter_mm",
                                         "stylet_diameter_mm",
                                         "length_mm",
                                         "bevel_deg",
                                         "bevel_share"};
  if (needle.is_biopsy) known.insert(known.end(), {"throw_mm", "notch_mm", "dead_space_mm", "is_coaxial"});
  TROCAR_TRY_STATUS(row.check_keys(known));
  TROCAR_TRY_STATUS(read_value(row, "outer_diameter_mm", {0.2, 5.0}, needle.outer_diameter_mm));
  TROCAR_TRY_STATUS(read_value(row, "inner_diameter_mm", {0.0, 5.0}, needle.inner_diameter_mm));
  if (needle.inner_diameter_mm > kThinnestWall * needle.outer_diameter_mm)
    return fail("inner_diameter_mm leaves no wall", row.where(), "give at most 0.95 of the outer diameter");
  TROCAR_TRY_STATUS(read_value(row, "stylet_diameter_mm", {0.0, 5.0}, needle.stylet_diameter_mm));
  if (needle.stylet_diameter_mm > needle.inner_diameter_mm)
    return fail("stylet_diameter_mm is wider than the bore", row.where(), "make it smaller than the inner diameter");
  TROCAR_TRY_STATUS(read_value(row, "length_mm", {20.0, 300.0}, needle.length_mm));
  TROCAR_TRY_STATUS(read_value(row, "bevel_deg", {5.0, 90.0}, needle.bevel_deg));
  TROCAR_TRY_STATUS(read_value(row, "bevel_share", {0.0, 1.0}, needle.bevel_share));
  if (needle.is_biopsy) {
    TROCAR_TRY_STATUS(read_value(row, "throw_mm", {5.0, 40.0}, needle.throw_mm));
    TROCAR_TRY(needle.is_coaxial, row.boolean_or("is_coaxial", false));
    TROCAR_TRY_STATUS(read_value(row, "notch_mm", {3.0, 40.0}, needle.notch_mm));
    TROCAR_TRY_STATUS(read_value(row, "dead_space_mm", {0.0, 15.0}, needle.dead_space_mm));
    if (needle.notch_mm + needle.dead_space_mm > needle.throw_mm)
      return fail("notch and dead space are longer than the throw", row.where(), "shorten the notch or the dead space");
  }
  return needle;
}

}  // namespace

Result<std::vector<Needle>> load_needles(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"needles"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("needles"));
  std::vector<Needle> needles;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(Needle needle, read_needle(row, name));
    needles.push_back(std::move(needle));
  }
  return needles;
}

std::vector<Needle> needles_like(const std::vector<Needle>& needles, std::string_view name) {
  const auto own = std::find_if(needles.begin(), needles.end(), [&](const Needle& n) { return n.name == name; });
  std::vector<Needle> alike;
  if (own == needles.end()) return alike;
  std::copy_if(needles.begin(), needles.end(), std::back_inserter(alike),
               [&](const Needle& n) { return n.use == own->use; });
  return alike;
}

Result<Needle> load_needle(const std::filesystem::path& path, std::string_view name) {
  TROCAR_TRY(std::vector<Needle> needles, load_needles(path));
  const auto it = std::find_if(needles.begin(), needles.end(), [&](const Needle& n) { return n.name == name; });
  if (it != needles.end()) return std::move(*it);
  std::vector<std::string_view> names;
  for (const Needle& needle : needles) names.push_back(needle.name);
  return fail_usage(fmt::format("there is no needle \"{}\"", name), path.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

}  // namespace trocar::tasks
