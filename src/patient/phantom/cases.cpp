#include "phantom/cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "config/toml.h"
#include "core/random.h"
#include "core/text.h"

namespace trocar::phantom {
namespace {

struct NumberRow {
  std::string_view key;
  config::Range range;
  double BodyParameters::*member;
};

constexpr double kLeastFactor = 0.2, kLargestFactor = 5.0;  // of scale_body
constexpr std::array<NumberRow, 13> kNumbers{{
    {"height_cm", {145, 200}, &BodyParameters::height_cm},
    {"weight_kg", {38, 160}, &BodyParameters::weight_kg},
    {"age_years", {18, 95}, &BodyParameters::age_years},
    {"scoliosis_deg", {-45, 45}, &BodyParameters::scoliosis_deg},
    {"flexion", {0, 1}, &BodyParameters::flexion},
    {"interspace_share", {0.45, 1.2}, &BodyParameters::interspace_share},
    {"liver_size", {0.8, 1.15}, &BodyParameters::liver_size},
    {"lesion_diameter_mm", {6, 45}, &BodyParameters::lesion_diameter_mm},
    {"lesion_contrast_hu", {-80, 40}, &BodyParameters::lesion_contrast_hu},
    {"ascites_ml", {0, 8000}, &BodyParameters::ascites_ml},
    {"duct_diameter_mm", {2, 16}, &BodyParameters::duct_diameter_mm},
    {"obstruction_share", {0, 1}, &BodyParameters::obstruction_share},
    {"noise_hu", {3, 40}, &BodyParameters::noise_hu},
}};

Result<std::string> one_of(const config::TomlTable& table, std::string_view key, std::string fallback,
                           const std::vector<std::string_view>& allowed) {
  TROCAR_TRY(std::string text, table.string_or(key, std::move(fallback)));
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) return text;
  std::string list;
  for (const std::string_view a : allowed) list += (list.empty() ? "" : ", ") + std::string(a);
  return fail("\"" + text + "\" is no value of " + std::string(key), table.where(), "choose one of: " + list);
}

Result<BodyParameters> read_body(const config::TomlTable& table) {
  std::vector<std::string_view> keys{"sex", "phase", "has_obstruction"};
  BodyParameters body;
  for (const NumberRow& row : kNumbers) {
    keys.push_back(row.key);
    TROCAR_TRY(body.*row.member, table.number_or(row.key, row.range, body.*row.member));
  }
  TROCAR_TRY_STATUS(table.check_keys(keys));
  TROCAR_TRY(const std::string sex, one_of(table, "sex", "male", {"female", "male"}));
  body.sex = sex == "female" ? Sex::kFemale : Sex::kMale;
  TROCAR_TRY(body.phase, one_of(table, "phase", body.phase, {"native", "arterial", "portal-venous"}));
  TROCAR_TRY(body.has_obstruction, table.boolean_or("has_obstruction", false));
  return body;
}

Result<CaseDescription> read_case(const config::TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"name", "task", "difficulty", "description", "indication", "coagulation",
                                      "allergies", "seed", "posture", "body"}));
  CaseDescription description;
  TROCAR_TRY(description.name, table.string("name"));
  TROCAR_TRY(description.task, table.string("task"));
  TROCAR_TRY(const std::int64_t difficulty, table.integer("difficulty", {1, 5}));
  description.difficulty = static_cast<int>(difficulty);
  TROCAR_TRY(description.description, table.string("description"));
  TROCAR_TRY(description.indication, table.string("indication"));
  TROCAR_TRY(description.coagulation, table.string("coagulation"));
  TROCAR_TRY(description.allergies, table.string("allergies"));
  TROCAR_TRY(const std::int64_t seed, table.integer("seed", {1, 1e9}));
  description.seed = static_cast<std::uint64_t>(seed);
  TROCAR_TRY(const std::string posture, table.string("posture"));
  const auto found = anatomy::find_posture(posture);
  if (!found)
    return fail("\"" + posture + "\" is no posture", table.where(),
                "choose supine, prone, left-lateral, right-lateral or sitting");
  description.posture = *found;
  TROCAR_TRY(const config::TomlTable body, table.table("body"));
  TROCAR_TRY(description.body, read_body(body));
  return description;
}

}  // namespace

Result<std::vector<CaseDescription>> load_cases(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"cases"}));
  TROCAR_TRY(const std::vector<config::TomlTable> tables, document.tables("cases"));
  std::vector<CaseDescription> cases;
  for (const config::TomlTable& table : tables) {
    TROCAR_TRY(CaseDescription description, read_case(table));
    for (const CaseDescription& other : cases)
      if (other.name == description.name)
        return fail("the name \"" + description.name + "\" occurs twice", table.where(),
                    "give every case its own name");
    cases.push_back(std::move(description));
  }
  return cases;
}

Status scale_body(BodyParameters& body, std::string_view factors) {
  while (!factors.empty()) {
    const std::string_view one = factors.substr(0, factors.find(','));
    factors.remove_prefix(std::min(factors.size(), one.size() + 1));
    const std::string_view key = one.substr(0, one.find('='));
    const auto row = std::ranges::find(kNumbers, key, &NumberRow::key);
    if (row == kNumbers.end()) {
      std::vector<std::string_view> keys;
      for (const NumberRow& known : kNumbers) keys.push_back(known.key);
      return fail_usage(fmt::format("a body has no number \"{}\"", key), std::string(one),
                        fmt::format("there are: {}", fmt::join(keys, ", ")));
    }
    const auto factor = parse_number<double>(one.substr(std::min(one.size(), key.size() + 1)));
    if (!factor || !(*factor >= kLeastFactor && *factor <= kLargestFactor))
      return fail_usage(fmt::format("the factor of {} is no number from {} to {}", key, kLeastFactor, kLargestFactor),
                        std::string(one), "write it as weight_kg=1.3");
    body.*row->member = std::clamp(*factor * body.*row->member, row->range.low, row->range.high);
  }
  return {};
}

CaseDescription draw_case(std::uint64_t seed) {
  constexpr std::array<std::string_view, 4> kTasks{"liver-biopsy", "lumbar-puncture", "ascites-puncture", "ptcd"};
  Random random(mix64(seed ^ 0x76617279U));
  const auto draw = [&](double low, double high) { return random.uniform(low, high); };
  CaseDescription drawn;
  drawn.name = "variant";
  drawn.task = kTasks[static_cast<std::size_t>(seed % kTasks.size())];
  drawn.description = "a body drawn from the whole range of bodies";
  drawn.seed = seed;
  BodyParameters& body = drawn.body;
  body.sex = draw(0, 1) < 0.5 ? Sex::kFemale : Sex::kMale;
  body.height_cm = body.sex == Sex::kFemale ? draw(148, 182) : draw(158, 196);
  const double body_mass_index = draw(18, 38);
  body.weight_kg = body_mass_index * body.height_cm * body.height_cm * 1e-4;
  body.age_years = draw(20, 90);
  body.scoliosis_deg = draw(0, 1) < 0.3 ? draw(-25, 25) : draw(-5, 5);
  body.interspace_share = draw(0.6, 1.1);
  body.liver_size = draw(0.9, 1.06);
  body.lesion_diameter_mm = draw(10, 32);
  body.lesion_contrast_hu = draw(-55, -12);
  body.noise_hu = draw(8, 24);
  body.phase = draw(0, 1) < 0.75 ? "portal-venous" : (draw(0, 1) < 0.5 ? "arterial" : "native");
  const bool is_lumbar = drawn.task == "lumbar-puncture";
  if (is_lumbar) {
    body.flexion = draw(0.5, 1.0);
    drawn.posture = draw(0, 1) < 0.7 ? anatomy::Posture::kLeftLateral : anatomy::Posture::kSitting;
  }
  if (drawn.task == "ascites-puncture") body.ascites_ml = draw(600, 7000);
  if (drawn.task == "ptcd") {
    body.duct_diameter_mm = draw(7, 14);
    body.has_obstruction = true;
    body.obstruction_share = draw(0.1, 0.9);
  }
  return drawn;
}

}  // namespace trocar::phantom
