// HarmlessWords::load: harmless_words.toml and the names of structures.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/toml.h"
#include "dicom/pacs/detail/harmless_words.h"

namespace trocar::dicom::detail {
namespace fs = std::filesystem;
namespace {

constexpr const char* kListFile = "harmless_words.toml";
constexpr std::size_t kShortestWordOfAStructure = 2;

/// A word of the list; `others` are the characters beside small letters that it may have.
Result<std::u32string> read_word(const std::string& text, std::u32string_view others, const config::TomlTable& table) {
  const auto word = decoded(text, Repertoire::kUtf8);
  const auto is_allowed = [&](char32_t c) {
    return others.find(c) != std::u32string_view::npos || (is_latin_letter(c) && !is_latin_capital(c));
  };
  if (!word || word->empty() || !std::ranges::all_of(*word, is_allowed))
    return fail(fmt::format("\"{}\" is no single word in small letters", text), table.where(),
                "write words such as \"liver\"");
  return *word;
}

/// All lists of a section: every key is a list of words.
template <class Use>
Status read_section(const config::TomlTable& document, std::string_view name, std::u32string_view others, Use use) {
  TROCAR_TRY(const config::TomlTable section, document.table(name));
  for (const std::string& key : section.keys()) {
    TROCAR_TRY(const std::vector<std::string> list, section.strings(key));
    for (const std::string& text : list) {
      TROCAR_TRY(std::u32string word, read_word(text, others, section));
      use(std::move(word));
    }
  }
  return {};
}

}  // namespace

Status HarmlessWords::add_list(const fs::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"words", "units", "patterns", "codes"}));
  constexpr std::u32string_view kDigits = U"0123456789";
  const auto insert_into = [](Words& words) {
    return [&words](std::u32string word) { words.insert(std::move(word)); };
  };
  TROCAR_TRY_STATUS(read_section(document, "words", {}, insert_into(words_)));
  TROCAR_TRY_STATUS(read_section(document, "units", {}, insert_into(units_)));
  TROCAR_TRY_STATUS(read_section(document, "codes", kDigits, insert_into(code_words_)));
  return read_section(document, "patterns", U"#",
                      [this](std::u32string pattern) { patterns_.push_back(std::move(pattern)); });
}

void HarmlessWords::add_structure(std::string_view name) {
  std::u32string word;
  const auto finish = [&] {
    if (word.size() >= kShortestWordOfAStructure) structure_words_.insert(word);
    word.clear();
  };
  for (const char32_t c : decoded(name, Repertoire::kUtf8).value_or(std::u32string())) {
    if (is_latin_letter(c))
      word += latin_lower_case(c);
    else
      finish();
  }
  finish();
}

Status HarmlessWords::add_structures(const fs::path& data_folder) {
  TROCAR_TRY(const config::TomlTable structures, config::load_toml(data_folder / "structures.toml"));
  std::vector<std::string> names;
  const auto append = [&](const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
  };
  for (const char* key : {"background", "regions"}) {
    TROCAR_TRY(const std::vector<std::string> list, structures.strings(key));
    append(list);
  }
  TROCAR_TRY(const std::vector<config::TomlTable> rows, structures.tables("structures"));
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY(const std::vector<std::string> list, row.strings("names"));
    append(list);
  }
  TROCAR_TRY(const config::TomlTable total, config::load_toml(data_folder / "totalsegmentator.toml"));
  TROCAR_TRY(const config::TomlTable others, config::load_toml(data_folder / "totalsegmentator_tasks.toml"));
  TROCAR_TRY(const config::TomlTable tasks, others.table("tasks"));
  std::vector<config::TomlTable> maps;
  TROCAR_TRY(maps.emplace_back(), total.table("labels"));
  for (const std::string& task : tasks.keys()) {
    TROCAR_TRY(maps.emplace_back(), tasks.table(task));
  }
  TROCAR_TRY(const config::TomlTable codes, config::load_toml(data_folder / "structure_codes.toml"));
  TROCAR_TRY(const std::vector<std::string> unused, codes.strings("unused"));
  append(unused);
  for (const char* scheme : {"SCT", "SRT"}) {
    TROCAR_TRY(maps.emplace_back(), codes.table(scheme));
  }
  for (const config::TomlTable& map : maps)
    for (const std::string& number : map.keys()) {
      TROCAR_TRY(names.emplace_back(), map.string(number));
    }
  constexpr std::string_view kMonth = "lip";  // July in Polish and Croatian: a part of a date
  for (const std::string& name : names)
    if (name != kMonth) add_structure(name);
  return {};
}

Result<HarmlessWords> HarmlessWords::load(const fs::path& data_folder) {
  HarmlessWords words;
  TROCAR_TRY_STATUS(words.add_list(data_folder / kListFile));
  TROCAR_TRY_STATUS(words.add_structures(data_folder));
  return words;
}

}  // namespace trocar::dicom::detail
