#include "tasks/detail/task_rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace trocar::tasks::detail {
namespace {

constexpr config::Range kCoordinate_mm{-1e5, 1e5};
constexpr config::Range kOverSkin_mm{-150.0, 150.0};
constexpr config::Range kZoneRadius_mm{1.0, 200.0};

Status read_entry_zone(const config::TomlTable& document, Task& task) {
  if (!document.has("entry_zone")) return {};
  TROCAR_TRY(const config::TomlTable table, document.table("entry_zone"));
  if (!table.has("landmark")) {
    TROCAR_TRY_STATUS(table.check_keys({"centre_mm", "radius_mm"}));
    EntryZone zone;
    TROCAR_TRY(zone.centre_P, read_point(table, "centre_mm"));
    TROCAR_TRY(zone.radius_mm, table.number("radius_mm", kZoneRadius_mm));
    task.entry_zone = zone;
    task.landmark_zone.reset();
    return {};
  }
  TROCAR_TRY_STATUS(table.check_keys({"landmark", "medial_mm", "cranial_mm", "radius_mm"}));
  LandmarkZone zone;
  TROCAR_TRY(zone.landmark, table.string("landmark"));
  TROCAR_TRY(zone.medial_mm, table.number_or("medial_mm", kOverSkin_mm, 0.0));
  TROCAR_TRY(zone.cranial_mm, table.number_or("cranial_mm", kOverSkin_mm, 0.0));
  TROCAR_TRY(zone.radius_mm, table.number("radius_mm", kZoneRadius_mm));
  const bool has_side = zone.landmark.starts_with("left ") || zone.landmark.starts_with("right ");
  if (zone.medial_mm != 0.0 && !has_side)
    return fail(fmt::format("the landmark \"{}\" has no side, and medial_mm needs one", zone.landmark), table.where(),
                "name a landmark that begins with left or right");
  task.landmark_zone = zone;
  task.entry_zone.reset();
  return {};
}

Status read_highest_entry(const config::TomlTable& document, Task& task) {
  if (!document.has("highest_entry")) return {};
  TROCAR_TRY(const config::TomlTable table, document.table("highest_entry"));
  TROCAR_TRY_STATUS(table.check_keys({"above", "reason"}));
  EntryLevel entry;
  TROCAR_TRY(entry.above, table.string("above"));
  TROCAR_TRY(entry.reason, table.string("reason"));
  task.highest_entry = std::move(entry);
  return {};
}

Status read_bevel(const config::TomlTable& document, Task& task) {
  if (!document.has("bevel")) return {};
  TROCAR_TRY(const config::TomlTable table, document.table("bevel"));
  TROCAR_TRY_STATUS(table.check_keys({"layer", "fibres", "tolerance_deg"}));
  BevelRule bevel;
  TROCAR_TRY(bevel.layer, table.string("layer"));
  TROCAR_TRY(bevel.fibres, table.string("fibres"));
  TROCAR_TRY(bevel.tolerance_deg, table.number("tolerance_deg", {1.0, 90.0}));
  task.bevel = std::move(bevel);
  return {};
}

Result<Tier> read_level(const config::TomlTable& row) {
  TROCAR_TRY_STATUS(
      row.check_keys({"name", "title", "breathing_mm", "tremor_mm", "time_limit_s", "tolerance_share", "body"}));
  Tier level;
  TROCAR_TRY(level.name, row.string("name"));
  TROCAR_TRY(level.title, row.string("title"));
  if (row.has("breathing_mm")) {
    TROCAR_TRY(level.breathing_mm, row.number("breathing_mm", {0.0, 40.0}));
  }
  TROCAR_TRY(level.tremor_mm, row.number_or("tremor_mm", {0.0, 3.0}, 0.0));
  TROCAR_TRY(level.time_limit_s, row.number_or("time_limit_s", {0.0, 3600.0}, 0.0));
  TROCAR_TRY(level.tolerance_share, row.number_or("tolerance_share", {0.1, 2.0}, 1.0));
  if (!row.has("body")) return level;
  TROCAR_TRY(const config::TomlTable body, row.table("body"));
  for (const std::string& key : body.keys()) {
    TROCAR_TRY(level.body[key], body.number(key, {0.2, 5.0}));
  }
  return level;
}

Status read_levels(const config::TomlTable& document, Task& task) {
  if (!document.has("levels")) return {};
  TROCAR_TRY(const std::vector<config::TomlTable> rows, document.tables("levels"));
  task.levels.clear();
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY(Tier level, read_level(row));
    if (std::ranges::find(task.levels, level.name, &Tier::name) != task.levels.end())
      return fail(fmt::format("two levels are named \"{}\"", level.name), row.where(), "give each level its own name");
    task.levels.push_back(std::move(level));
  }
  return {};
}

void write_level(config::TomlWriter& writer, const Tier& level) {
  writer.begin_row("levels");
  writer.set("name", level.name);
  writer.set("title", level.title);
  if (level.breathing_mm) writer.set("breathing_mm", *level.breathing_mm);
  writer.set("tremor_mm", level.tremor_mm);
  writer.set("time_limit_s", level.time_limit_s);
  writer.set("tolerance_share", level.tolerance_share);
  std::vector<config::TomlValue::Entry> body;
  for (const auto& [key, factor] : level.body) body.push_back({key, factor});
  if (!body.empty()) writer.set("body", config::TomlValue(body));
}

void write_zone(config::TomlWriter& writer, const Task& task, const Task& base) {
  if (task.entry_zone) {
    const Vec3& p = task.entry_zone->centre_P;
    writer.begin_table({"entry_zone"});
    writer.set("centre_mm", std::vector<double>{p.x(), p.y(), p.z()});
    writer.set("radius_mm", task.entry_zone->radius_mm);
  } else if (task.landmark_zone && task.landmark_zone != base.landmark_zone) {
    writer.begin_table({"entry_zone"});
    writer.set("landmark", task.landmark_zone->landmark);
    writer.set("medial_mm", task.landmark_zone->medial_mm);
    writer.set("cranial_mm", task.landmark_zone->cranial_mm);
    writer.set("radius_mm", task.landmark_zone->radius_mm);
  }
}

}  // namespace

Result<Vec3> read_point(const config::TomlTable& table, const char* key) {
  TROCAR_TRY(const std::vector<double> numbers, table.numbers(key, kCoordinate_mm));
  if (numbers.size() == 3) return Vec3(numbers[0], numbers[1], numbers[2]);
  return fail(fmt::format("{} is not a point", key), table.where(), "write [x, y, z] in mm (LPS)");
}

Result<anatomy::Posture> read_posture(const std::string& name, const std::string& where) {
  if (const auto posture = anatomy::find_posture(name)) return *posture;
  return fail(fmt::format("there is no posture \"{}\"", name), where,
              "write supine, prone, left-lateral, right-lateral or sitting");
}

Result<std::vector<anatomy::Posture>> read_postures(const config::TomlTable& path) {
  TROCAR_TRY(const std::vector<std::string> names, path.strings("postures"));
  std::vector<anatomy::Posture> postures;
  for (const std::string& name : names) {
    TROCAR_TRY(const anatomy::Posture posture, read_posture(name, path.where()));
    if (std::ranges::find(postures, posture) == postures.end()) postures.push_back(posture);
  }
  return postures;
}

std::vector<std::string> names_of(const std::vector<anatomy::Posture>& postures) {
  std::vector<std::string> names;
  for (const anatomy::Posture posture : postures) names.emplace_back(anatomy::posture_name(posture));
  return names;
}

Status read_rules(const config::TomlTable& document, Task& task) {
  TROCAR_TRY_STATUS(read_entry_zone(document, task));
  TROCAR_TRY_STATUS(read_highest_entry(document, task));
  return read_bevel(document, task);
}

Status read_level_of(const config::TomlTable& document, Task& task) {
  TROCAR_TRY_STATUS(read_levels(document, task));
  if (!document.has("level")) return {};
  TROCAR_TRY(const std::string name, document.string("level"));
  TROCAR_TRY(task, at_level(std::move(task), name));
  return {};
}

void write_rules(config::TomlWriter& writer, const Task& task, const Task& base) {
  write_zone(writer, task, base);
  if (task.highest_entry && task.highest_entry != base.highest_entry) {
    writer.begin_table({"highest_entry"});
    writer.set("above", task.highest_entry->above);
    writer.set("reason", task.highest_entry->reason);
  }
  if (task.bevel && task.bevel != base.bevel) {
    writer.begin_table({"bevel"});
    writer.set("layer", task.bevel->layer);
    writer.set("fibres", task.bevel->fibres);
    writer.set("tolerance_deg", task.bevel->tolerance_deg);
  }
  if (task.levels != base.levels)
    for (const Tier& level : task.levels) write_level(writer, level);
}

}  // namespace trocar::tasks::detail
