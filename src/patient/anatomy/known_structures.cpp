#include "anatomy/known_structures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "config/toml.h"
#include "core/text.h"

namespace trocar::anatomy {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

const KnownStructure* KnownStructures::find(std::string_view name) const {
  const std::string plain = plain_name(name);
  const std::string key = without_side(plain);
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) {
    return (!r.needs_side || key.size() < plain.size()) && r.pattern.matches(key);
  });
  return row != rows_.end() ? &structures_[row->structure] : nullptr;
}

bool KnownStructures::is_background(std::string_view name) const {
  return std::find(background_.begin(), background_.end(), plain_name(name)) != background_.end();
}

bool KnownStructures::is_region(std::string_view name) const {
  return std::find(regions_.begin(), regions_.end(), plain_name(name)) != regions_.end();
}

std::vector<std::string> KnownStructures::similar_names(std::string_view name, std::size_t count) const {
  const std::string wanted = plain_name(name);
  std::vector<std::pair<std::size_t, std::string>> candidates;
  const auto consider = [&](const std::string& known) {
    const std::string spelled = plain_name(known);
    const std::size_t distance = edit_distance(wanted, spelled);
    // With more changes it is another word, not a misspelling: "my_roi" is not "thyroid".
    const std::size_t allowed = std::max<std::size_t>(1, (std::max(wanted.size(), spelled.size()) + 1) / 4);
    if (distance <= allowed) candidates.emplace_back(distance, known);
  };
  for (const std::string& known : totalsegmentator_) consider(known);
  for (const Row& row : rows_) {
    if (row.pattern.has_region()) continue;  // this includes all names of TotalSegmentator
    const std::string& known = row.pattern.stem();
    const auto spelled = [&](const auto& candidate) { return plain_name(candidate.second) == known; };
    if (std::none_of(candidates.begin(), candidates.end(), spelled)) consider(known);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t n = 0; n < std::min(count, candidates.size()); ++n) names.push_back(candidates[n].second);
  return names;
}

namespace {

constexpr std::array<std::string_view, 2> kSides = {"left", "right"};
constexpr std::string_view kSeparators = "_- ";
constexpr std::string_view kSpineRegions = "ctls";

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), ascii::is_digit);
}

bool is_name_character(char c) {
  return ascii::is_letter_or_digit(c) || kSeparators.find(c) != std::string_view::npos;
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (ascii::is_letter_or_digit(c)) text += ascii::to_lower(c);
  }
  return text;
}

std::string without_side(std::string plain) {
  for (const std::string_view side : kSides) {
    if (const auto at = plain.find(side); at != std::string::npos) plain.erase(at, side.size());
  }
  return plain;
}

std::optional<StructurePattern> StructurePattern::parse(std::string_view text) {
  const std::string_view stem = text.substr(0, text.find_first_of("%#*"));
  const std::string_view end = text.substr(stem.size());
  if (!std::all_of(stem.begin(), stem.end(), is_name_character)) return std::nullopt;
  if (!end.empty() && end != "#" && end != "%#" && end != "*") return std::nullopt;
  StructurePattern pattern;
  pattern.stem_ = plain_name(stem);
  pattern.end_ = std::string(end);
  if (pattern.stem_.empty() || pattern.stem_ != without_side(pattern.stem_)) return std::nullopt;
  return pattern;
}

bool StructurePattern::matches(std::string_view key) const {
  if (!key.starts_with(stem_)) return false;
  std::string_view rest = key.substr(stem_.size());
  if (end_.empty()) return rest.empty();
  if (end_ == "*") return true;
  if (has_region()) {
    if (rest.empty() || kSpineRegions.find(rest.front()) == std::string_view::npos) return false;
    rest.remove_prefix(1);
  }
  return is_digits(rest);
}

}  // namespace trocar::anatomy

// KnownStructures::load: structures.toml and totalsegmentator.toml.

namespace trocar::anatomy {
namespace {

constexpr config::Range kPriorities{0, 1000};
constexpr config::Range kColorValues{0, 255};
constexpr std::size_t kMaxLabels = 255;

Result<image::Rgb> read_color(const config::TomlTable& colors, const std::string& name) {
  TROCAR_TRY(const std::vector<double> values, colors.numbers(name, kColorValues));
  const bool is_whole = std::all_of(values.begin(), values.end(), [](double v) { return v == std::floor(v); });
  if (values.size() != 3 || !is_whole)
    return fail(fmt::format("the colour \"{}\" is not three whole numbers", name), colors.where(),
                "write [red, green, blue], each 0 to 255");
  return image::Rgb{static_cast<std::uint8_t>(values[0]), static_cast<std::uint8_t>(values[1]),
                    static_cast<std::uint8_t>(values[2])};
}

template <class T>
Result<T> named(const std::map<std::string, T>& values, const config::TomlTable& row, std::string_view key,
                std::string_view section) {
  TROCAR_TRY(const std::string name, row.string(key));
  const auto found = values.find(name);
  if (found == values.end())
    return fail(fmt::format("there is no {} \"{}\"", key, name), row.where(), fmt::format("add it to [{}]", section));
  return found->second;
}

}  // namespace

/// Fills a KnownStructures from its files.
class StructureReader {
 public:
  Status read_structures(const config::TomlTable& document) {
    TROCAR_TRY_STATUS(document.check_keys({"background", "regions", "priorities", "colours", "structures"}));
    known_.file_ = document.where();
    TROCAR_TRY(const std::vector<std::string> background, document.strings("background"));
    for (const std::string& name : background) known_.background_.push_back(plain_name(name));
    TROCAR_TRY(const std::vector<std::string> regions, document.strings("regions"));
    for (const std::string& name : regions) known_.regions_.push_back(plain_name(name));
    TROCAR_TRY(const config::TomlTable priorities, document.table("priorities"));
    for (const std::string& name : priorities.keys()) {
      TROCAR_TRY(const std::int64_t priority, priorities.integer(name, kPriorities));
      priorities_[name] = static_cast<int>(priority);
    }
    TROCAR_TRY(const config::TomlTable colors, document.table("colours"));
    for (const std::string& name : colors.keys()) {
      TROCAR_TRY(colors_[name], read_color(colors, name));
    }
    TROCAR_TRY(const std::vector<config::TomlTable> rows, document.tables("structures"));
    if (rows.empty()) return fail("there is no structure", document.where(), "add [[structures]]");
    for (const config::TomlTable& row : rows) TROCAR_TRY_STATUS(read_structure(row));
    return {};
  }

  Status read_totalsegmentator(const config::TomlTable& document) {
    TROCAR_TRY_STATUS(document.check_keys({"labels"}));
    TROCAR_TRY(const config::TomlTable labels, document.table("labels"));
    std::vector<std::string>& names = known_.totalsegmentator_;
    for (const std::string& key : labels.keys()) {
      if (key != std::to_string(names.size() + 1) || names.size() == kMaxLabels)
        return fail(fmt::format("label number {} is not the next one", key), labels.where(),
                    fmt::format("count from 1 to at most {} without a gap", kMaxLabels));
      TROCAR_TRY(std::string name, labels.string(key));
      if (std::find(names.begin(), names.end(), name) != names.end())
        return fail(fmt::format("\"{}\" has two numbers", name), labels.where(), "remove one");
      names.push_back(std::move(name));
    }
    return {};
  }

  KnownStructures take() { return std::move(known_); }

 private:
  Status read_structure(const config::TomlTable& row) {
    TROCAR_TRY_STATUS(row.check_keys({"names", "with_side", "tissue", "colour", "priority"}));
    KnownStructure structure;
    TROCAR_TRY(structure.tissue, row.string("tissue"));
    TROCAR_TRY(structure.color, named(colors_, row, "colour", "colours"));
    TROCAR_TRY(structure.priority, named(priorities_, row, "priority", "priorities"));
    TROCAR_TRY(const std::vector<std::string> names, row.strings("names"));
    if (names.empty()) return fail("the structure has no name", row.where(), "give names = [\"…\"]");
    known_.structures_.push_back(std::move(structure));
    for (const std::string& name : names) TROCAR_TRY_STATUS(add_name(name, row, false));
    if (!row.has("with_side")) return {};
    TROCAR_TRY(const std::vector<std::string> with_side, row.strings("with_side"));
    for (const std::string& name : with_side) TROCAR_TRY_STATUS(add_name(name, row, true));
    return {};
  }

  Status add_name(const std::string& name, const config::TomlTable& row, bool needs_side) {
    auto pattern = StructurePattern::parse(name);
    if (!pattern)
      return fail(fmt::format("no structure can have the name \"{}\"", name), row.where(),
                  "use letters, digits, '_', without left and right; only the end may be '#', '%#' or '*'");
    std::vector<KnownStructures::Row>& rows = known_.rows_;
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const auto& other) { return other.pattern == *pattern && other.needs_side == needs_side; }))
      return fail(fmt::format("the name \"{}\" occurs twice", name), row.where(), "remove one");
    rows.push_back({*std::move(pattern), needs_side, known_.structures_.size() - 1});
    return {};
  }

  KnownStructures known_;
  std::map<std::string, int> priorities_;
  std::map<std::string, image::Rgb> colors_;
};

Result<KnownStructures> KnownStructures::load(const std::filesystem::path& data_folder) {
  StructureReader reader;
  TROCAR_TRY(const config::TomlTable structures, config::load_toml(data_folder / kStructuresFile));
  TROCAR_TRY_STATUS(reader.read_structures(structures));
  TROCAR_TRY(const config::TomlTable totalsegmentator, config::load_toml(data_folder / "totalsegmentator.toml"));
  TROCAR_TRY_STATUS(reader.read_totalsegmentator(totalsegmentator));
  return reader.take();
}

}  // namespace trocar::anatomy
