#include "tasks/action.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "config/toml.h"

namespace trocar::tasks {
namespace {

constexpr std::array kActionNames{"anaesthetise", "draw_stylet", "replace_stylet", "aspirate", "advance_wire",
                                  "hold_breath",  "breathe",     "fire",           "load"};
static_assert(kActionNames.size() == static_cast<std::size_t>(kLastAction) + 1);

}  // namespace

const char* to_string(ActionKind kind) noexcept {
  return kActionNames[static_cast<std::size_t>(kind)];
}

const Action* find_wire(std::span<const Action> actions, double time_s) noexcept {
  const Action* wire = nullptr;
  for (const Action& action : actions) {
    if (action.time_s > time_s) break;
    if (action.kind == ActionKind::kAdvanceWire) wire = &action;
    if (action.kind == ActionKind::kReplaceStylet) wire = nullptr;
  }
  return wire;
}

std::optional<Return> last_return(std::span<const Action> actions) noexcept {
  for (auto action = actions.rbegin(); action != actions.rend(); ++action)
    if (action->kind == ActionKind::kDrawStylet || action->kind == ActionKind::kAspirate) return action->result;
  return std::nullopt;
}

bool is_gun_loaded(std::span<const Action> actions) noexcept {
  bool is_loaded = true;
  for (const Action& action : actions) {
    if (action.kind == ActionKind::kFire) is_loaded = false;
    if (action.kind == ActionKind::kLoad) is_loaded = true;
  }
  return is_loaded;
}

namespace {

constexpr std::array kSubstanceNames{"nothing", "blood", "csf",           "ascites", "bile",
                                     "urine",   "air",   "bowel_content", "fluid"};
static_assert(kSubstanceNames.size() == static_cast<std::size_t>(kLastSubstance) + 1);

constexpr std::array kWords{"nothing", "blood", "spinal fluid",  "ascites", "bile",
                            "urine",   "air",   "bowel content", "fluid"};
static_assert(kWords.size() == kSubstanceNames.size());

constexpr int kPoints = 9;  // along the bevel's opening

Result<Substance> read_substance(const config::TomlTable& table, const std::string& key) {
  TROCAR_TRY(const std::string name, table.string(key));
  if (const auto substance = find_substance(name)) return *substance;
  return fail(fmt::format("there is no substance \"{}\"", name), table.where(),
              fmt::format("write one of: {}", fmt::join(kSubstanceNames, ", ")));
}

Status read_substances(const config::TomlTable& document, std::string_view section,
                       std::map<std::string, Substance, std::less<>>& substances) {
  if (!document.has(section)) return {};
  TROCAR_TRY(const config::TomlTable table, document.table(section));
  for (const std::string& key : table.keys()) {
    TROCAR_TRY(substances[key], read_substance(table, key));
  }
  return {};
}

/// "kidney_left_2" -> "kidney"
std::string_view plain_name(std::string_view name) {
  while (!name.empty()) {
    const auto last = name.rfind('_');
    const std::string_view end = last == std::string_view::npos ? std::string_view() : name.substr(last + 1);
    const bool is_number = !end.empty() && end.find_first_not_of("0123456789") == std::string_view::npos;
    if (!is_number && end != "left" && end != "right") break;
    name = name.substr(0, last);
  }
  return name;
}

}  // namespace

const char* to_string(Substance substance) noexcept {
  return kSubstanceNames[static_cast<std::size_t>(substance)];
}

const char* substance_words(Substance substance) noexcept {
  return kWords[static_cast<std::size_t>(substance)];
}

std::optional<Substance> find_substance(std::string_view name) noexcept {
  const auto found = std::find(kSubstanceNames.begin(), kSubstanceNames.end(), name);
  if (found == kSubstanceNames.end()) return std::nullopt;
  return static_cast<Substance>(found - kSubstanceNames.begin());
}

Substance SubstanceTable::of(const anatomy::Label& label, bool is_aspirated) const {
  if (const auto found = labels.find(plain_name(label.name)); found != labels.end()) return found->second;
  if (const auto found = tissues.find(label.tissue); found != tissues.end()) return found->second;
  if (!is_aspirated) return Substance::kNothing;
  const auto found = aspirated.find(label.tissue);
  return found != aspirated.end() ? found->second : Substance::kNothing;
}

Result<SubstanceTable> load_substances(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"tissues", "labels", "aspirated", "looks"}));
  SubstanceTable table;
  TROCAR_TRY_STATUS(read_substances(document, "tissues", table.tissues));
  TROCAR_TRY_STATUS(read_substances(document, "labels", table.labels));
  TROCAR_TRY_STATUS(read_substances(document, "aspirated", table.aspirated));
  TROCAR_TRY(const config::TomlTable looks, document.table("looks"));
  TROCAR_TRY_STATUS(looks.check_keys({kSubstanceNames.begin(), kSubstanceNames.end()}));
  for (const char* name : kSubstanceNames) {
    TROCAR_TRY(const config::TomlTable row, looks.table(name));
    TROCAR_TRY_STATUS(row.check_keys({"flows", "aspirated"}));
    SubstanceLook& look = table.looks[*find_substance(name)];
    TROCAR_TRY(look.flows, row.string("flows"));
    TROCAR_TRY(look.aspirated, row.string("aspirated"));
  }
  return table;
}

double bevel_opening_mm(const Needle& needle) noexcept {
  const double bevel_rad = radians(std::clamp(needle.bevel_deg, 5.0, 90.0));
  return std::max(0.2, needle.outer_diameter_mm / std::tan(bevel_rad));
}

Return what_returns(const SubstanceTable& table, const anatomy::VirtualPatient& patient, const Needle& needle,
                    const Vec3& tip_P, const Vec3& axis_P, bool is_aspirated) {
  const double opening_mm = bevel_opening_mm(needle);
  std::array<int, kSubstanceNames.size()> points{};
  for (int n = 0; n < kPoints; ++n) {
    const double back_mm = opening_mm * n / (kPoints - 1);
    const anatomy::Label* const label = anatomy::find_label(patient, tip_P - back_mm * axis_P);
    if (label != nullptr) ++points[static_cast<std::size_t>(table.of(*label, is_aspirated))];
  }
  const auto most = std::max_element(points.begin() + 1, points.end());
  if (*most == 0) return {};
  return {static_cast<Substance>(most - points.begin()), static_cast<double>(*most) / kPoints};
}

std::vector<ContrastInjection> find_injections(std::span<const XrayUse> uses) {
  std::vector<ContrastInjection> found;
  double before_ml = 0.0;
  for (const XrayUse& use : uses) {
    const double ml = use.contrast_ml - before_ml;
    before_ml = use.contrast_ml;
    if (!(ml > 0.0)) continue;
    if (found.empty() || use.time_s - found.back().end_s > kBetweenInjections_s)
      found.push_back({use.time_s, 0.0, 0.0});
    found.back().end_s = use.time_s;
    found.back().ml += ml;
    found.back().total_ml = use.contrast_ml;
  }
  return found;
}

}  // namespace trocar::tasks
