#include "tasks/harm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace trocar::tasks {
namespace {

constexpr std::array kHarmNames{"none", "minor", "major", "critical"};
constexpr config::Range kStay_s{0.1, 3600.0};

Result<Harm> read_grade(const config::TomlTable& row, const char* key) {
  TROCAR_TRY(const std::string name, row.string(key));
  if (const auto grade = find_harm_grade(name)) return *grade;
  return fail(fmt::format("{} = \"{}\" is no grade of harm", key, name), row.where(),
              "write none, minor, major or critical");
}

Result<HarmRule> read_rule(const config::TomlTable& row) {
  HarmRule rule;
  TROCAR_TRY(rule.name_texts, row.strings("names"));
  TROCAR_TRY(rule.tissues, row.strings("tissues"));
  for (const std::string& name : rule.name_texts) {
    auto pattern = anatomy::StructurePattern::parse(name);
    if (!pattern)
      return fail(fmt::format("no label can be named \"{}\"", name), row.where(),
                  "write a name as in structures.toml, without left and right");
    rule.names.push_back(*std::move(pattern));
  }
  if (rule.names.empty() && rule.tissues.empty())
    return fail("a row of harm is for nothing", row.where(), "give names, tissues or both");
  TROCAR_TRY(rule.grade, read_grade(row, "grade"));
  if (row.has("notch")) {
    TROCAR_TRY(rule.notch, read_grade(row, "notch"));
  }
  if (row.has("stay") != row.has("stay_s"))
    return fail("stay and stay_s belong together", row.where(), "give both, or none");
  if (row.has("stay")) {
    TROCAR_TRY(rule.stay, read_grade(row, "stay"));
    TROCAR_TRY(rule.stay_s, row.number("stay_s", kStay_s));
  }
  TROCAR_TRY(rule.reason, row.string("reason"));
  if (rule.reason.empty())
    return fail("a row of harm has no reason", row.where(),
                "say what happens to the patient: it is told to the trainee");
  for (const std::optional<Harm>& other : {rule.notch, rule.stay})
    if (other && *other < rule.grade)
      return fail("notch or stay is milder than grade", row.where(), "let them be as grave or graver");
  TROCAR_TRY(rule.source, row.string_or("source", ""));
  return rule;
}

}  // namespace

const char* to_string(Harm harm) noexcept {
  return kHarmNames[static_cast<std::size_t>(harm)];
}

std::optional<Harm> find_harm_grade(std::string_view name) noexcept {
  const auto found = std::find(kHarmNames.begin(), kHarmNames.end(), name);
  if (found == kHarmNames.end()) return std::nullopt;
  return static_cast<Harm>(found - kHarmNames.begin());
}

bool HarmRule::matches(std::string_view plain, std::string_view tissue) const {
  const bool is_named =
      names.empty() || std::any_of(names.begin(), names.end(), [&](const auto& name) { return name.matches(plain); });
  return is_named && (tissues.empty() || std::find(tissues.begin(), tissues.end(), tissue) != tissues.end());
}

bool HarmRule::is_for(std::span<const std::string> target_tissues) const {
  return targets.empty() || std::ranges::find_first_of(targets, target_tissues) != targets.end();
}

Result<std::vector<HarmRule>> load_harm_table(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"harms"}));
  TROCAR_TRY(const std::vector<config::TomlTable> rows, document.tables("harms"));
  std::vector<HarmRule> rules;
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY_STATUS(
        row.check_keys({"names", "tissues", "targets", "grade", "notch", "stay", "stay_s", "reason", "source"}));
    TROCAR_TRY(HarmRule rule, read_rule(row));
    TROCAR_TRY(rule.targets, row.strings("targets"));
    rules.push_back(std::move(rule));
  }
  return rules;
}

Result<std::vector<HarmRule>> read_harm_rules(const config::TomlTable& document) {
  TROCAR_TRY(const std::vector<config::TomlTable> rows, document.tables("harms"));
  std::vector<HarmRule> rules;
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY_STATUS(row.check_keys({"names", "tissues", "grade", "notch", "stay", "stay_s", "reason", "source"}));
    TROCAR_TRY(HarmRule rule, read_rule(row));
    rule.is_own = true;
    rules.push_back(std::move(rule));
  }
  return rules;
}

}  // namespace trocar::tasks
