#include "io/patient/detail/number_schemes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "config/toml.h"
#include "core/files/folders.h"
#include "core/text.h"
#include "io/patient/label_map.h"

namespace trocar::io::detail {
namespace {

constexpr std::string_view kTask = "totalsegmentator:";
constexpr std::string_view kVersion1 = "totalsegmentator:total_v1";
constexpr const char* kTasksFile = "totalsegmentator_tasks.toml";
constexpr const char* kDatasetsFile = "dataset_labels.toml";

NumberScheme totalsegmentator(const anatomy::KnownStructures& structures) {
  NumberScheme scheme{std::string(kTotalSegmentator), "TotalSegmentator 2", {}};
  for (const std::string& name : structures.totalsegmentator_names())
    scheme.names.emplace(static_cast<int>(scheme.names.size() + 1), name);
  return scheme;
}

/// 5 = "liver"
Result<std::map<int, std::string>> names_in(const config::TomlTable& table) {
  std::map<int, std::string> names;
  for (const std::string& key : table.keys()) {
    const auto number = parse_number<int>(key);
    if (!number || *number < 1 || *number > kMaxLabel)
      return fail(fmt::format("\"{}\" is not a label number from 1 to {}", key, kMaxLabel), table.where(),
                  "write lines such as 5 = \"liver\"");
    TROCAR_TRY(names[*number], table.string(key));
  }
  return names;
}

Result<config::TomlTable> load_data(const char* file) {
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  return config::load_toml(data_folder / file);
}

/// [tasks.NAME] of totalsegmentator_tasks.toml.
Result<NumberScheme> load_task(const std::string& name, const std::string& where) {
  TROCAR_TRY(const config::TomlTable file, load_data(kTasksFile));
  TROCAR_TRY(const config::TomlTable tasks, file.table("tasks"));
  const std::string task = name.substr(kTask.size());
  if (!tasks.has(task))
    return fail_usage(fmt::format("TotalSegmentator has no task \"{}\" with own numbers; there are {}", task,
                                  fmt::join(tasks.keys(), ", ")),
                      where, "write totalsegmentator:TASK, or totalsegmentator for the task total");
  TROCAR_TRY(const config::TomlTable table, tasks.table(task));
  NumberScheme scheme{name, name == kVersion1 ? "TotalSegmentator 1 (total_v1)" : name, {}};
  TROCAR_TRY(scheme.names, names_in(table));
  return scheme;
}

Result<NumberScheme> read_dataset(const std::string& name, const config::TomlTable& table) {
  TROCAR_TRY_STATUS(table.check_keys({"title", "source", "labels"}));
  TROCAR_TRY_STATUS(table.string("source").map([](const auto&) {}));
  NumberScheme scheme{name, {}, {}};
  TROCAR_TRY(scheme.words, table.string("title"));
  TROCAR_TRY(const config::TomlTable labels, table.table("labels"));
  TROCAR_TRY(scheme.names, names_in(labels));
  return scheme;
}

}  // namespace

Result<NumberScheme> load_scheme(const std::string& name, const anatomy::KnownStructures& structures,
                                 const std::string& where) {
  if (name == kTotalSegmentator) return totalsegmentator(structures);
  if (name.starts_with(kTask)) return load_task(name, where);
  TROCAR_TRY(const config::TomlTable file, load_data(kDatasetsFile));
  if (!file.has(name))
    return fail_usage(fmt::format("there are no label numbers \"{}\"; there are totalsegmentator, "
                                  "totalsegmentator:TASK, {}",
                                  name, fmt::join(file.keys(), ", ")),
                      where, "write one of these names, or the path of a TOML file with [labels]");
  TROCAR_TRY(const config::TomlTable table, file.table(name));
  return read_dataset(name, table);
}

std::vector<NumberScheme> load_comparable_schemes(const anatomy::KnownStructures& structures) {
  std::vector<NumberScheme> schemes{totalsegmentator(structures)};
  if (auto version_1 = load_task(std::string(kVersion1), {})) schemes.push_back(*std::move(version_1));
  const auto file = load_data(kDatasetsFile);
  if (!file) return schemes;
  for (const std::string& name : file->keys())
    if (auto scheme = load_scheme(name, structures, {})) schemes.push_back(*std::move(scheme));
  return schemes;
}

namespace {

constexpr std::size_t kLongestName = 200;

/// The text between `begin` and the next `end`; moves `xml` behind it.
std::optional<std::string_view> take_until(std::string_view& xml, std::string_view end) {
  const std::size_t at = xml.find(end);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view text = xml.substr(0, at);
  xml.remove_prefix(at + end.size());
  return text;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && ascii::is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && ascii::is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Value of an attribute in " Key=\"5\" Red=\"1\"".
std::optional<std::string_view> attribute(std::string_view attributes, std::string_view name) {
  for (std::size_t at = attributes.find(name); at != std::string_view::npos; at = attributes.find(name, at + 1)) {
    const std::string_view rest = trimmed(attributes.substr(at + name.size()));
    if (at == 0 || !ascii::is_space(attributes[at - 1]) || !rest.starts_with('=')) continue;
    std::string_view quoted = trimmed(rest.substr(1));
    if (!quoted.starts_with('"') && !quoted.starts_with('\'')) return std::nullopt;
    const std::string_view quote = quoted.substr(0, 1);
    quoted.remove_prefix(1);
    return take_until(quoted, quote);
  }
  return std::nullopt;
}

std::string without_entities(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kEntities{
      {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}}};
  for (const auto& [entity, letter] : kEntities)
    for (std::size_t at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1))
      text.replace(at, entity.size(), letter);
  return text;
}

/// The content of an entry, which ends with </Label>; moves `xml` behind it.
std::optional<std::string> take_name(std::string_view& xml) {
  constexpr std::string_view kCdata = "<![CDATA[", kCdataEnd = "]]>", kEnd = "</Label>";
  const std::string_view start = trimmed(xml);
  if (!start.starts_with(kCdata)) {
    const auto text = take_until(xml, kEnd);
    return text ? std::optional(without_entities(std::string(trimmed(*text)))) : std::nullopt;
  }
  xml = start.substr(kCdata.size());
  const auto text = take_until(xml, kCdataEnd);
  if (!text || !take_until(xml, kEnd)) return std::nullopt;
  return std::string(trimmed(*text));
}

}  // namespace

Result<std::map<int, std::string>> read_label_table(std::string_view xml, const std::string& where) {
  const auto damaged = [&](const std::string& what) {
    return fail(fmt::format("the label table in the header: {}", what), where, "write the file again");
  };
  std::map<int, std::string> names;
  while (take_until(xml, "<Label")) {
    if (xml.empty() || !ascii::is_space(xml.front())) continue;  // <LabelTable>
    const auto attributes = take_until(xml, ">");
    const auto key = attributes ? attribute(*attributes, "Key") : std::nullopt;
    const auto number = key ? parse_number<int>(std::string(trimmed(*key))) : std::nullopt;
    if (!number) return damaged("an entry has no Key with a number");
    auto name = attributes->ends_with('/') ? std::optional(std::string()) : take_name(xml);
    if (!name) return damaged(fmt::format("the entry of {} has no end", *number));
    if (*number < 1 || *number > kMaxLabel) continue;
    if (name->size() > kLongestName ||
        std::any_of(name->begin(), name->end(), [](unsigned char c) { return c < 0x20; }))
      return damaged(fmt::format("the name of {} is no name", *number));
    const auto [entry, is_new] = names.emplace(*number, *name);
    if (!is_new && entry->second != *name)
      return damaged(fmt::format("{} has two names, \"{}\" and \"{}\"", *number, entry->second, *name));
  }
  return names;
}

}  // namespace trocar::io::detail
