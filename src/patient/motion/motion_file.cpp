#include "motion/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/content_hash.h"

namespace trocar::motion {
namespace {

using config::Range;
using config::TomlTable;

constexpr int kFormat = 1;
constexpr double kFar = 1e4;
constexpr std::array<const char*, 3> kProfileNames{"uniform", "ramp", "bump"};
constexpr const char* kEverywhere = "every";

std::vector<double> numbers(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Result<Vec3> read_vector(const TomlTable& table, std::string_view key) {
  TROCAR_TRY(const std::vector<double> values, table.numbers(key, Range{-kFar, kFar}));
  if (values.size() != 3) return fail("needs three numbers", fmt::format("{}, {}", table.where(), key), "correct it");
  return Vec3(values[0], values[1], values[2]);
}

Result<MotionRegion> read_region(const TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"name", "sides"}));
  MotionRegion region;
  TROCAR_TRY(region.name, table.string("name"));
  if (!table.has("sides")) return region;
  TROCAR_TRY(const auto rows, table.rows("sides", 4, Range{-kFar, kFar}));
  for (const std::vector<double>& row : rows) region.sides.push_back({Vec3(row[0], row[1], row[2]), row[3]});
  return region;
}

/// Position of a name in a list of names; -1: it is not there.
template <class Names>
int find(const Names& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

Result<MotionMode> read_mode(const TomlTable& table, const MotionParts& parts) {
  TROCAR_TRY_STATUS(
      table.check_keys({"driver", "region", "profile", "displacement_mm", "centre", "axis", "extent_mm"}));
  TROCAR_TRY(const std::string driver, table.string("driver"));
  TROCAR_TRY(const std::string region, table.string("region"));
  TROCAR_TRY(const std::string profile, table.string("profile"));
  std::vector<std::string> regions;
  for (const MotionRegion& one : parts.regions) regions.push_back(one.name);
  MotionMode mode;
  mode.driver = find(parts.drivers, driver);
  mode.region = region == kEverywhere ? MotionMode::kEveryRegion : find(regions, region);
  const int shape = find(kProfileNames, std::string_view(profile));
  if (mode.driver < 0 || shape < 0 || (mode.region < 0 && region != kEverywhere))
    return fail(fmt::format("driver {}, region {} or profile {} is unknown", driver, region, profile), table.where(),
                "use the names above in the file, and the profiles uniform, ramp or bump");
  mode.profile = static_cast<Profile>(shape);
  TROCAR_TRY(mode.displacement_mm, read_vector(table, "displacement_mm"));
  if (mode.profile == Profile::kUniform) return mode;
  TROCAR_TRY(mode.centre_A, read_vector(table, "centre"));
  TROCAR_TRY(mode.extent_mm, table.number("extent_mm", Range{0.0, kFar}));
  if (mode.profile != Profile::kRamp) return mode;
  TROCAR_TRY(mode.axis_A, read_vector(table, "axis"));
  return mode;
}

}  // namespace

std::string to_toml(const MotionModel& model) {
  const MotionParts& parts = model.parts();
  config::TomlWriter writer;
  writer.comment("How the patient moves against the CT; lengths in mm, directions and places in LPS.");
  writer.set("format", kFormat);
  writer.set("drivers", parts.drivers);
  for (const MotionRegion& region : parts.regions) {
    writer.begin_row("region");
    writer.set("name", region.name);
    std::vector<config::TomlValue> rows;
    for (const HalfSpace& side : region.sides) {
      std::vector<double> row = numbers(side.normal_A);
      row.push_back(side.offset_mm);
      rows.emplace_back(row);
    }
    if (!rows.empty()) writer.set("sides", rows);
  }
  for (const MotionMode& mode : parts.modes) {
    writer.begin_row("mode");
    writer.set("driver", parts.drivers[static_cast<std::size_t>(mode.driver)]);
    writer.set("region", mode.region == MotionMode::kEveryRegion
                             ? std::string(kEverywhere)
                             : parts.regions[static_cast<std::size_t>(mode.region)].name);
    writer.set("profile", kProfileNames[static_cast<std::size_t>(mode.profile)]);
    writer.set("displacement_mm", numbers(mode.displacement_mm));
    if (mode.profile == Profile::kUniform) continue;
    writer.set("centre", numbers(mode.centre_A));
    writer.set("extent_mm", mode.extent_mm);
    if (mode.profile == Profile::kRamp) writer.set("axis", numbers(mode.axis_A));
  }
  return writer.text();
}

Result<std::shared_ptr<const MotionModel>> parse_motion(std::string_view text, const std::string& name) {
  TROCAR_TRY(const TomlTable table, config::parse_toml(text, name));
  TROCAR_TRY_STATUS(table.check_keys({"format", "drivers", "region", "mode"}));
  TROCAR_TRY(const std::int64_t format, table.integer("format", Range{1.0, 1e6}));
  if (format > kFormat)
    return fail(fmt::format("was written by a newer version (format {})", format), name, "install the newer version");
  MotionParts parts;
  TROCAR_TRY(parts.drivers, table.strings("drivers"));
  TROCAR_TRY(const std::vector<TomlTable> regions, table.tables("region"));
  for (const TomlTable& one : regions) {
    TROCAR_TRY(MotionRegion region, read_region(one));
    parts.regions.push_back(std::move(region));
  }
  TROCAR_TRY(const std::vector<TomlTable> modes, table.tables("mode"));
  for (const TomlTable& one : modes) {
    TROCAR_TRY(const MotionMode mode, read_mode(one, parts));
    parts.modes.push_back(mode);
  }
  return MotionModel::make(std::move(parts), name);
}

std::string hash_motion(const MotionParts& parts) {
  ContentHash hash;
  const auto add_text = [&](const std::string& text) {
    const auto size = static_cast<std::uint64_t>(text.size());
    hash.add(std::as_bytes(std::span(&size, 1)));
    hash.add(std::as_bytes(std::span(text)));
  };
  const auto add_numbers = [&](std::initializer_list<double> values) {
    hash.add(std::as_bytes(std::span(values.begin(), values.size())));
  };
  const auto add_vector = [&](const Vec3& v) { add_numbers({v.x(), v.y(), v.z()}); };
  for (const std::string& driver : parts.drivers) add_text(driver);
  for (const MotionRegion& region : parts.regions) {
    add_text(region.name);
    for (const HalfSpace& side : region.sides) {
      add_vector(side.normal_A);
      add_numbers({side.offset_mm});
    }
  }
  for (const MotionMode& mode : parts.modes) {
    add_numbers(
        {static_cast<double>(mode.driver), static_cast<double>(mode.region), static_cast<double>(mode.profile)});
    for (const Vec3& v : {mode.displacement_mm, mode.centre_A, mode.axis_A}) add_vector(v);
    add_numbers({mode.extent_mm});
  }
  return hash.digest();
}

}  // namespace trocar::motion
