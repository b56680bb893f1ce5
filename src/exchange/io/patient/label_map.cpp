#include "io/patient/label_map.h"

#include <fmt/format.h>

#include "anatomy/build_patient.h"
#include "config/toml.h"
#include "core/files/data_dir.h"
#include "core/parse_number.h"

namespace trocar::io {
namespace {

constexpr int kMaxLabel = 255;
constexpr std::string_view kTotalSegmentator = "totalsegmentator";
constexpr std::string_view kRest = "*";

std::map<int, std::string> totalsegmentator_names(const anatomy::KnownStructures& structures) {
  std::map<int, std::string> names;
  for (const std::string& name : structures.totalsegmentator_names())
    names.emplace(static_cast<int>(names.size() + 1), name);
  return names;
}

/// The list as texts; its TOML entries can be numbers or texts.
Result<std::vector<std::string>> ignored_labels(const config::TomlTable& file) {
  if (!file.has("ignore")) return std::vector<std::string>{};
  if (auto names = file.strings("ignore")) return names;
  const auto numbers = file.numbers("ignore", {1, kMaxLabel});
  if (!numbers)
    return fail(fmt::format("must be a list of numbers from 1 to {}, or of texts in quotes", kMaxLabel),
                file.where() + ": ignore", "write ignore = [3, 4] or ignore = [\"3\", \"my_roi\"]");
  std::vector<std::string> names;
  for (const double number : *numbers) names.push_back(fmt::format("{}", number));
  return names;
}

}  // namespace

Status LabelMap::read_entry(const std::string& key, std::string name, const std::string& where) {
  if (key == kRest) {
    rest_ = std::move(name);
    return {};
  }
  const std::optional<int> number = parse_number<int>(key);
  if (number && (*number < 1 || *number > kMaxLabel))
    return fail(fmt::format("\"{}\" is not a label number from 1 to {}", key, kMaxLabel), where,
                "write lines such as 5 = \"liver\"");
  if (number) by_number_.insert_or_assign(*number, name);
  by_name_.insert_or_assign(key, std::move(name));
  return {};
}

Result<LabelMap> LabelMap::load(const std::string& label_map) {
  LabelMap map;
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(map.structures_, anatomy::KnownStructures::load(data_folder));
  if (label_map.empty()) return map;
  if (label_map == kTotalSegmentator) {
    map.by_number_ = totalsegmentator_names(map.structures_);
    return map;
  }
  TROCAR_TRY(const config::TomlTable file, config::load_toml(label_map));
  TROCAR_TRY_STATUS(file.check_keys({"base", "ignore", "labels"}));
  TROCAR_TRY(const std::string base, file.string_or("base", ""));
  if (!base.empty() && base != kTotalSegmentator)
    return fail(fmt::format("unknown base \"{}\"", base), file.where(), "write base = \"totalsegmentator\"");
  if (!base.empty()) map.by_number_ = totalsegmentator_names(map.structures_);
  TROCAR_TRY(const std::vector<std::string> ignored, ignored_labels(file));
  for (const std::string& key : ignored)
    TROCAR_TRY_STATUS(map.read_entry(key, std::string(anatomy::kIgnoredStructure), file.where() + ": ignore"));
  if (!file.has("labels") && (!base.empty() || !ignored.empty())) return map;
  TROCAR_TRY(const config::TomlTable table, file.table("labels"));
  for (const std::string& key : table.keys()) {
    TROCAR_TRY(std::string name, table.string(key));
    TROCAR_TRY_STATUS(map.read_entry(key, std::move(name), table.where()));
  }
  return map;
}

std::optional<std::string> LabelMap::name_of(int number) const {
  const auto found = by_number_.find(number);
  return found != by_number_.end() ? std::optional(found->second) : rest_;
}

std::string LabelMap::name_of(const std::string& name) const {
  if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
  return rest_ && structures_.find(name) == nullptr && !structures_.is_background(name) ? *rest_ : name;
}

}  // namespace trocar::io
