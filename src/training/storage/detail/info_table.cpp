#include "storage/detail/info_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "storage/detail/database.h"

namespace trocar::storage::detail {
namespace {

/// The single list of the contents of `info`: calls visit(key, field) for each member; strings, numbers and truth
/// values.
template <class Info, class Visitor>
void visit_info(Info& info, Visitor&& visit) {
  visit("program_version", info.program_version);
  visit("started_utc", info.started_utc);
  visit("task", info.task);
  visit("patient_name", info.patient_name);
  visit("patient_source", info.patient_source);
  visit("patient_hash", info.patient_hash);
  visit("patient_seed", info.patient_seed);
  visit("operator", info.operator_name);
  visit("force_model", info.force_model);
  visit("seed", info.seed);
  visit("rate_hz", info.rate_hz);
  visit("needle", info.needle);
  visit("device", info.device);
  visit("tissue_table_toml", info.tissue_table_toml);
  visit("plan_name", info.plan_P.name);
  visit("plan_entry_x_mm", info.plan_P.line_P.a[0]);
  visit("plan_entry_y_mm", info.plan_P.line_P.a[1]);
  visit("plan_entry_z_mm", info.plan_P.line_P.a[2]);
  visit("plan_target_x_mm", info.plan_P.line_P.b[0]);
  visit("plan_target_y_mm", info.plan_P.line_P.b[1]);
  visit("plan_target_z_mm", info.plan_P.line_P.b[2]);
  visit("is_parenchymal", info.is_parenchymal);
}

/// Likewise; not in sessions of older programs.
template <class Info, class Visitor>
void visit_added_info(Info& info, Visitor&& visit) {
  visit("task_toml", info.task_toml);
  visit("motion_hash", info.motion_hash);
  visit("device_preset", info.device_preset);
  visit("level", info.level);
  visit("attempt_id", info.attempt_id);
  visit("person_id", info.person_id);
}

template <class Field>
Field parse_number(const std::string& key, const std::string& text) {
  Field value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw soci::soci_error(fmt::format("\"{}\" is no number", key));
  return value;
}

bool parse_truth(const std::string& key, const std::string& text) {
  if (text != "0" && text != "1") throw soci::soci_error(fmt::format("\"{}\" is neither 0 nor 1", key));
  return text == "1";
}

constexpr const char* kForceVersionKey = "force_version";  // not in sessions of older programs
constexpr int kMostForceVersion = 1'000'000'000;

int parse_force_version(const std::string& text) {
  const int version = parse_number<int>(kForceVersionKey, text);
  if (version < 1 || version > kMostForceVersion) throw soci::soci_error("the version of the forces is out of range");
  return version;
}

constexpr const char* kPlaneKey = "image_plane";

/// The seven numbers of an image plane, separated by blanks, in the order of its members; empty: there is none.
std::string plane_text(const std::optional<metrics::ImagePlane>& plane) {
  if (!plane) return {};
  return fmt::format("{} {} {} {} {} {} {}", plane->depth_mm, plane->radius_mm, plane->field_of_view_rad,
                     plane->width_mm, plane->slice_mm, plane->elevation_mm, plane->elevation_focus_mm);
}

std::optional<metrics::ImagePlane> parse_plane(const std::string& text) {
  if (text.empty()) return std::nullopt;
  metrics::ImagePlane plane;
  double* const members[] = {&plane.depth_mm, &plane.radius_mm,    &plane.field_of_view_rad, &plane.width_mm,
                             &plane.slice_mm, &plane.elevation_mm, &plane.elevation_focus_mm};
  std::istringstream words(text);
  std::string word;
  for (double* const member : members) {
    if (!(words >> word)) throw soci::soci_error("the image plane is incomplete");
    *member = parse_number<double>(kPlaneKey, word);
    if (!std::isfinite(*member)) throw soci::soci_error("the image plane is not finite");
  }
  return plane;
}

void write_names(soci::session& database, const std::string& table, const std::vector<std::string>& names) {
  int id = 0;
  std::string name;
  soci::statement insert =
      (database.prepare << "INSERT INTO " + table + " (id, name) VALUES (:id, :name)", soci::use(id), soci::use(name));
  for (id = 0; static_cast<std::size_t>(id) < names.size(); ++id) {
    name = names[static_cast<std::size_t>(id)];
    insert.execute(true);
  }
}

std::vector<std::string> read_names(soci::session& database, const std::string& table) {
  std::vector<std::string> names;
  std::string name;
  soci::statement select = (database.prepare << "SELECT name FROM " + table + " ORDER BY id", soci::into(name));
  select.execute();
  while (select.fetch()) {
    if (names.size() >= kMaxNames || name.size() > kMaxNameBytes) throw soci::soci_error("the names are too long");
    names.push_back(name);
  }
  return names;
}

}  // namespace

void write_info(soci::session& database, const SessionInfo& info) {
  std::string key;
  std::string value;
  soci::statement insert =
      (database.prepare << "INSERT INTO info (key, value) VALUES (:key, :value)", soci::use(key), soci::use(value));
  visit_info(info, [&](const char* name, const auto& field) {
    key = name;
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, bool>)
      value = fmt::format("{:d}", field);
    else
      value = fmt::format("{}", field);
    insert.execute(true);
  });
  visit_added_info(info, [&](const char* name, const std::string& field) {
    key = name;
    value = field;
    insert.execute(true);
  });
  key = kForceVersionKey;
  value = fmt::format("{}", info.force_version);
  insert.execute(true);
  if (info.plane) {
    key = kPlaneKey;
    value = plane_text(info.plane);
    insert.execute(true);
  }
  write_names(database, "tissues", info.tissue_names);
  write_names(database, "layers", info.layer_names);
  write_names(database, "labels", info.label_names);
  std::vector<std::string> phases;
  for (const auto phase : {telemetry::InsertionPhase::kOutside, telemetry::InsertionPhase::kLoading,
                           telemetry::InsertionPhase::kInserted, telemetry::InsertionPhase::kRetracting})
    phases.emplace_back(to_string(phase));
  write_names(database, "phases", phases);
}

SessionInfo read_info(soci::session& database) {
  std::map<std::string, std::string> values;
  {
    std::string key;
    std::string value;
    soci::statement select = (database.prepare << "SELECT key, value FROM info", soci::into(key), soci::into(value));
    select.execute();
    std::size_t bytes = 0;
    while (select.fetch()) {
      bytes += key.size() + value.size();
      if (values.size() >= kMaxInfoRows || bytes > kMaxInfoBytes) throw soci::soci_error("the texts are too long");
      values[key] = value;
    }
  }
  SessionInfo info;
  visit_info(info, [&](const char* name, auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    const auto found = values.find(name);
    if (found == values.end()) throw soci::soci_error(fmt::format("\"{}\" is missing", name));
    if constexpr (std::is_same_v<Field, std::string>)
      field = found->second;
    else if constexpr (std::is_same_v<Field, bool>)
      field = parse_truth(name, found->second);
    else
      field = parse_number<Field>(name, found->second);
  });
  visit_added_info(info, [&](const char* name, std::string& field) {
    if (const auto found = values.find(name); found != values.end()) field = found->second;
  });
  if (!(info.rate_hz > 0.0 && std::isfinite(info.rate_hz))) throw soci::soci_error("the rate is none");
  if (const auto found = values.find(kForceVersionKey); found != values.end())
    info.force_version = parse_force_version(found->second);
  if (const auto found = values.find(kPlaneKey); found != values.end()) info.plane = parse_plane(found->second);
  info.tissue_names = read_names(database, "tissues");
  info.layer_names = read_names(database, "layers");
  info.label_names = read_names(database, "labels");
  return info;
}

}  // namespace trocar::storage::detail
