#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "config/toml.h"
#include "core/result.h"

namespace trocar::tasks {

/// What it means if a needle goes into a structure, from harmless to deadly; data/harm.toml says what each grade is.
enum class Harm : std::uint8_t { kNone, kMinor, kMajor, kCritical };
/// "none", "minor", "major", "critical".
const char* to_string(Harm harm) noexcept;
std::optional<Harm> find_harm_grade(std::string_view name) noexcept;

/// A row of the table of harm.
struct HarmRule {
  std::vector<anatomy::StructurePattern> names;  ///< Any of them; empty: by the tissue alone.
  std::vector<std::string> tissues;              ///< Any of them; empty: by the name alone.
  std::vector<std::string> targets;              ///< Only tasks with one of these target tissues; empty: all.
  Harm grade = Harm::kMajor;
  std::optional<Harm> notch;            ///< If the specimen notch of a biopsy gun closes in it.
  std::optional<Harm> stay;             ///< If the needle stays in it for longer than `stay_s`.
  double stay_s = 0.0;                  ///< Range 0.1..3600.
  std::string reason;                   ///< What happens to the patient: "bile gets into the belly: peritonitis".
  std::string source;                   ///< Empty: assumed.
  std::vector<std::string> name_texts;  ///< `names` as written.
  bool is_own = false;                  ///< Of the task's file, not of the table.

  /// `plain`: name of the label as anatomy::plain_name, without its side.
  bool matches(std::string_view plain, std::string_view tissue) const;
  /// `target_tissues`: those of the task.
  bool is_for(std::span<const std::string> target_tissues) const;
  bool operator==(const HarmRule&) const = default;
};

/// File in the data folder, beside the folder of the tasks.
inline constexpr const char* kHarmFile = "harm.toml";

/// The rows of the table, in its order. Errors name file and row: an unknown key, grade or name, a row without names
/// and tissues, a stay without a time.
Result<std::vector<HarmRule>> load_harm_table(const std::filesystem::path& file);
/// The [[harms]] of a task's file: rows of the same form, without `targets`.
Result<std::vector<HarmRule>> read_harm_rules(const config::TomlTable& document);

}  // namespace trocar::tasks
