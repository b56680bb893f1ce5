#include "io/patient/label_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "config/toml.h"
#include "core/files/folders.h"
#include "core/text.h"
#include "io/patient/detail/number_schemes.h"
#include "patient_builder/build_patient.h"
#include "patient_builder/derive/derive_structures.h"

namespace trocar::io {
namespace {

constexpr std::string_view kRest = "*";
constexpr const char* kCodesFile = "structure_codes.toml";

/// "Kidney left" as a structure name: "kidney_left".
std::string structure_name(std::string_view meaning) {
  std::string name;
  for (const char letter : meaning) {
    const bool is_separator = letter == ' ' || letter == '-' || letter == ',';
    if (is_separator && !name.empty() && name.back() == '_') continue;
    name += is_separator ? '_' : ascii::to_lower(letter);
  }
  return name;
}

/// Words of a name without side and number: "Lymph node, left", "lymph_node_2" are "lymph node".
std::string words_of(std::string_view name) {
  std::string words;
  std::string word;
  const auto end_word = [&] {
    const bool is_number = !word.empty() && std::all_of(word.begin(), word.end(), ascii::is_digit);
    if (!word.empty() && !is_number && word != "left" && word != "right") words += (words.empty() ? "" : " ") + word;
    word.clear();
  };
  for (const char letter : name)
    if (letter == ' ' || letter == '_' || letter == '-' || letter == ',')
      end_word();
    else
      word += ascii::to_lower(letter);
  end_word();
  return words;
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

/// "Lt Lung", "Kidney_L" as "Lung left", "Kidney left": how structure sets abbreviate sides (AAPM TG-263: "_L", "_R").
std::string with_whole_side(const std::string& name) {
  std::string rest;
  std::string side;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find_first_of(" _", begin), name.size());
    const std::string word = name.substr(begin, end - begin);
    const bool is_last = end == name.size();
    if (word == "Lt" || word == "lt" || word == "LT" || (is_last && (word == "L" || word == "l")))
      side = " left";
    else if (word == "Rt" || word == "rt" || word == "RT" || (is_last && (word == "R" || word == "r")))
      side = " right";
    else
      rest += (rest.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return rest + side;
}

/// "left", "right" or nothing.
std::string_view side_in(const std::string& name) {
  const std::string plain = structure_name(with_whole_side(name));
  return plain.find("left") != std::string::npos ? "left" : plain.find("right") != std::string::npos ? "right" : "";
}

/// The last word if it is a number or a vertebra's: "3" of "Rib 3 left", "l1" of "vertebrae_L1".
std::string level_in(const std::string& name) {
  std::string level, word;
  for (const char letter : structure_name(name) + "_") {
    if (letter != '_') {
      word += letter;
      continue;
    }
    const std::string_view digits = std::string_view(word).substr(!word.empty() && !ascii::is_digit(word[0]) ? 1 : 0);
    if (word != "left" && word != "right")
      level = !digits.empty() && std::all_of(digits.begin(), digits.end(), ascii::is_digit) ? word : std::string();
    word.clear();
  }
  return level;
}

/// Words without side, level and plural: "Vertebra" and "vertebrae_L1" are the same.
std::string kind_of(const std::string& name) {
  std::string words = words_of(with_whole_side(name));
  if (const std::string level = level_in(name); !level.empty() && words.ends_with(" " + level))
    words.resize(words.size() - level.size() - 1);
  for (const char end : {'s', 'e'})
    if (words.ends_with(end)) words.pop_back();
  return words;
}

/// True for a name of many structures: it leaves the choice to a code of the same tissue.
bool is_unspecific(const std::string& name) {
  const std::string kind = kind_of(name);
  return kind == "bon" || kind == "artery" || kind == "vein" || kind == "muscl";
}

/// A name of numbers (btcv), not the path of a file.
bool is_scheme_name(const std::string& label_map) {
  std::error_code error;
  return label_map.find_first_of("/.") == std::string::npos && !std::filesystem::is_regular_file(label_map, error);
}

/// " 5", "5.0", "+5": meant as a number, and equal to none.
bool is_almost_number(const std::string& key) {
  return !parse_number<int>(key) && std::any_of(key.begin(), key.end(), ascii::is_digit) &&
         key.find_first_not_of("0123456789.+- \t") == std::string::npos;
}

}  // namespace

Status LabelMap::read_base(const std::string& base, const std::string& where) {
  TROCAR_TRY(detail::NumberScheme scheme, detail::load_scheme(base, structures_, where));
  by_number_ = std::move(scheme.names);
  base_ = base;
  base_words_ = std::move(scheme.words);
  return {};
}

Status LabelMap::read_codes(const std::filesystem::path& data_folder) {
  TROCAR_TRY(const config::TomlTable file, config::load_toml(data_folder / kCodesFile));
  TROCAR_TRY(const std::vector<std::string> unused, file.strings("unused"));
  for (const std::string& name : unused) {
    if (is_known(name))
      return fail(fmt::format("\"{}\" is a known structure", name), file.where() + ": unused", "remove it");
    unused_.insert(words_of(name));
  }
  TROCAR_TRY(const std::vector<std::string> generic, file.strings("generic"));
  generic_codes_.insert(generic.begin(), generic.end());
  for (const std::string& scheme : file.keys()) {
    if (scheme == "unused" || scheme == "generic") continue;
    TROCAR_TRY(const config::TomlTable codes, file.table(scheme));
    for (const std::string& code : codes.keys()) {
      TROCAR_TRY(std::string name, codes.string(code));
      if (!is_known(name) && !is_unused(name) && !structures_.is_region(name))
        return fail(fmt::format("\"{}\" is no known structure", name), codes.where(),
                    "use a name of structures.toml, or of unused");
      by_code_[scheme + ":" + code] = std::move(name);
    }
  }
  return {};
}

Status LabelMap::read_entry(const std::string& key, std::string name, const std::string& where) {
  if (key == kRest) {
    rest_ = std::move(name);
    return {};
  }
  const std::optional<int> number = parse_number<int>(key);
  if (is_almost_number(key))
    return fail(fmt::format("\"{}\" is no number of a label", key), where, "write lines such as 5 = \"liver\"");
  if (parse_number<int>(name))
    return fail(fmt::format("{} = \"{}\": the number comes first", key, name), where,
                fmt::format("write {} = \"{}\"", name, key));
  if (number && (*number < 1 || *number > kMaxLabel))
    return fail(fmt::format("\"{}\" is not a label number from 1 to {}", key, kMaxLabel), where,
                "write lines such as 5 = \"liver\"");
  if (number) {
    by_number_.insert_or_assign(*number, name);
    own_numbers_.insert(*number);
  }
  by_name_.insert_or_assign(key, std::move(name));
  return {};
}

Result<LabelMap> LabelMap::load(const std::string& label_map) {
  LabelMap map;
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(map.structures_, anatomy::KnownStructures::load(data_folder));
  TROCAR_TRY_STATUS(map.read_codes(data_folder));
  if (label_map.empty()) return map;
  if (is_scheme_name(label_map)) {
    TROCAR_TRY_STATUS(map.read_base(label_map, "--label-map"));
    return map;
  }
  map.file_ = label_map;
  TROCAR_TRY(const config::TomlTable file, config::load_toml(label_map));
  TROCAR_TRY_STATUS(file.check_keys({"base", "ignore", "labels"}));
  TROCAR_TRY(const std::string base, file.string_or("base", ""));
  if (!base.empty()) TROCAR_TRY_STATUS(map.read_base(base, file.where()));
  TROCAR_TRY(const std::vector<std::string> ignored, ignored_labels(file));
  for (const std::string& key : ignored)
    TROCAR_TRY_STATUS(map.read_entry(key, std::string(patient_builder::kIgnoredStructure), file.where() + ": ignore"));
  if (!file.has("labels") && (!base.empty() || !ignored.empty())) return map;
  TROCAR_TRY(const config::TomlTable table, file.table("labels"));
  for (const std::string& key : table.keys()) {
    TROCAR_TRY(std::string name, table.string(key));
    TROCAR_TRY_STATUS(map.read_entry(key, std::move(name), table.where()));
  }
  return map;
}

std::vector<patient_builder::OtherReading> LabelMap::other_readings(
    const std::vector<std::pair<int, std::string>>& given) const {
  std::vector<patient_builder::OtherReading> readings;
  if (std::ranges::all_of(given, [&](const auto& entry) { return own_numbers_.contains(entry.first); }))
    return readings;
  for (const detail::NumberScheme& scheme : detail::load_comparable_schemes(structures_)) {
    patient_builder::OtherReading other{scheme.name, scheme.words, {}, {}};
    if (!file_.empty()) other.advice = fmt::format("write base = \"{}\" in {}", scheme.name, file_);
    for (const auto& [value, name] : given) {
      const auto found = scheme.names.find(value);
      if (own_numbers_.contains(value) || (found == scheme.names.end() && rest_))
        other.names.emplace_back(value, name);
      else if (found != scheme.names.end())
        other.names.emplace_back(value, found->second);
    }
    if (other.names != given && other.names.size() == given.size()) readings.push_back(std::move(other));
  }
  return readings;
}

bool LabelMap::is_chosen() const noexcept {
  return !base_.empty() && (!is_default() || !file_.empty());
}

bool LabelMap::is_default() const noexcept {
  return base_ == detail::kTotalSegmentator;
}

std::string LabelMap::name_in_file_name(const std::string& stem) const {
  if (by_name_.contains(stem) || is_known(stem)) return stem;
  const std::size_t at = stem.find_last_of("_-. ");
  if (at == std::string::npos) return stem;
  std::string end;
  for (const char letter : stem.substr(at + 1)) end += ascii::to_lower(letter);
  constexpr std::array<std::string_view, 7> kEnds{"seg", "segmentation", "mask", "label", "labels", "roi", "contour"};
  const std::string start = stem.substr(0, at);
  const bool is_named = std::ranges::find(kEnds, end) != kEnds.end() && (by_name_.contains(start) || is_known(start));
  return is_named ? start : stem;
}

bool LabelMap::is_structure_file(const std::string& stem) const {
  // "pancreas_001": the number of a case.
  const std::size_t end = stem.find_last_not_of("0123456789_- ");
  return by_name_.contains(stem) || is_known(stem) || (end != std::string::npos && is_known(stem.substr(0, end + 1)));
}

std::optional<std::string> LabelMap::name_of(int number) const {
  const auto found = by_number_.find(number);
  return found != by_number_.end() ? std::optional(found->second) : rest_;
}

std::string LabelMap::name_of(const std::string& name) const {
  if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
  return rest_ && structures_.find(name) == nullptr && !structures_.is_background(name) && !structures_.is_region(name)
             ? *rest_
             : name;
}

bool LabelMap::is_unused(const std::string& name) const {
  return !is_known(name) && unused_.contains(words_of(name));
}

std::optional<std::string> LabelMap::name_of_code(const std::string& code) const {
  const std::size_t end = std::min(code.find(' '), code.size());
  const auto found = by_code_.find(std::string_view(code).substr(0, end));
  return found != by_code_.end() ? std::optional(found->second + structure_name(code.substr(end))) : std::nullopt;
}

std::optional<std::string> LabelMap::specified_by_code(const DescribedSegment& segment) const {
  const auto by_code = segment.codes.empty() ? std::nullopt : name_of_code(segment.codes.front());
  const anatomy::KnownStructure* named = structures_.find(segment.name);
  const anatomy::KnownStructure* coded = by_code ? structures_.find(*by_code) : nullptr;
  if (named == nullptr || coded == nullptr || named->tissue != coded->tissue) return std::nullopt;
  const std::string_view side = side_in(segment.name);
  const std::string level = level_in(segment.name);
  if ((!side.empty() && side != side_in(*by_code)) || (!level.empty() && level != level_in(*by_code)))
    return std::nullopt;
  const bool is_kind = kind_of(segment.name) == kind_of(*by_code);
  const bool adds = side != side_in(*by_code) || level != level_in(*by_code);
  return (is_kind && adds) || (!is_kind && is_unspecific(segment.name)) ? by_code : std::nullopt;
}

std::string LabelMap::contradiction_in(const DescribedSegment& segment) const {
  if (segment.codes.empty()) return {};
  for (const std::string& key : {segment.name, std::to_string(segment.number)})
    if (by_name_.contains(key)) return {};
  const std::string name = name_of(segment);
  const auto by_code = name_of_code(segment.codes.front());
  const anatomy::KnownStructure* named = structures_.find(name);
  const anatomy::KnownStructure* coded = by_code ? structures_.find(*by_code) : nullptr;
  if (named == nullptr || coded == nullptr || name == *by_code) return {};
  if (named->tissue != coded->tissue)
    return fmt::format("the segment \"{}\" is read by its name ({}), but its code {} is {} ({})", segment.name,
                       named->tissue, segment.codes.front(), *by_code, coded->tissue);
  const auto differ = [](std::string_view a, std::string_view b) { return !a.empty() && !b.empty() && a != b; };
  if (!differ(side_in(name), side_in(*by_code)) && !differ(level_in(name), level_in(*by_code))) return {};
  return fmt::format("the segment \"{}\" is read by its name, but its code {} is {}", segment.name,
                     segment.codes.front(), *by_code);
}

std::string LabelMap::name_of(const DescribedSegment& segment) const {
  for (const std::string& key : {segment.name, std::to_string(segment.number)})
    if (const auto found = by_name_.find(key); found != by_name_.end()) return found->second;
  if (patient_builder::is_marked_derived(segment.name)) return segment.name;
  const bool is_meaning = !segment.codes.empty() && !segment.meanings.empty() &&
                          words_of(segment.name) == words_of(segment.meanings.front());
  if (const auto by_code = is_meaning ? name_of_code(segment.codes.front()) : std::nullopt;
      by_code && is_known(*by_code) && is_known(segment.name) &&
      structures_.find(*by_code)->tissue != structures_.find(segment.name)->tissue)
    return *by_code;
  if (auto specified = specified_by_code(segment)) return *std::move(specified);
  if (is_known(segment.name) || structures_.is_background(segment.name) || structures_.is_region(segment.name))
    return segment.name;
  if (const std::string name = with_whole_side(segment.name); is_known(name)) return structure_name(name);
  if (is_known(segment.type_in_region)) return structure_name(segment.type_in_region);
  for (std::size_t n = 0; n < segment.codes.size(); ++n) {
    const std::string& code = segment.codes[n];
    if (auto by_code = name_of_code(code)) return *std::move(by_code);
    if (n < segment.meanings.size() && is_known(segment.meanings[n])) return structure_name(segment.meanings[n]);
    if (!is_generic(code.substr(0, code.find(' ')))) break;  // a stent in the liver is not the liver
  }
  return rest_.value_or(segment.name);
}

}  // namespace trocar::io
