#include "io/patient/detail/number_schemes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "config/toml.h"
#include "core/files/data_dir.h"
#include "core/parse_number.h"
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

}  // namespace trocar::io::detail
