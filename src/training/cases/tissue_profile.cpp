#include "cases/tissue_profile.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::cases {
namespace {

constexpr std::size_t kLongestName = 80;

/// C0 controls and DEL. `char` may be signed or not: non-ASCII bytes of UTF-8 are neither.
bool is_control(char c) noexcept {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

bool is_ascii(char c) noexcept {
  return static_cast<unsigned char>(c) < 0x80;
}

Status check_name(const std::string& name) {
  const bool is_blank = std::all_of(name.begin(), name.end(), [](char c) { return c == ' '; });
  const bool has_control = std::any_of(name.begin(), name.end(), is_control);
  if (name.size() <= kLongestName && !is_blank && !has_control) return {};
  return fail_usage("a profile's name has 1 to 80 characters and no control characters", fmt::format("\"{}\"", name),
                    "give it another name");
}

std::string to_toml(const TissueProfile& profile) {
  config::TomlWriter writer;
  writer.comment("Numbers of tissues that differ from the table's (trocar run --set KEY=VALUE takes them, too).");
  writer.set("name", profile.name);
  if (!profile.note.empty()) writer.set("note", profile.note);
  if (!profile.force_model.empty()) writer.set("force_model", profile.force_model);
  writer.set("overrides", profile.overrides);
  return writer.text();
}

}  // namespace

std::filesystem::path profile_file(const std::filesystem::path& folder, const std::string& name) {
  std::string file = name;
  for (char& c : file) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || !is_ascii(c);
    if (!is_plain) c = '-';
  }
  return folder / (file + ".toml");
}

Status save_profile(const TissueProfile& profile, const anatomy::TissueTable& table,
                    const std::filesystem::path& folder, bool may_replace) {
  TROCAR_TRY_STATUS(check_name(profile.name));
  TROCAR_TRY_STATUS(with_profile(table, profile));
  const std::filesystem::path file = profile_file(folder, profile.name);
  std::error_code error;
  if (!may_replace && std::filesystem::exists(file, error))
    return fail_usage("there is a profile of that name already", file.string(), "choose another name, or replace it");
  std::filesystem::create_directories(folder, error);
  if (error)
    return fail("cannot create the folder: " + error.message(), folder.string(),
                "check the permissions of the folder above it");
  return write_file_atomically(file, to_toml(profile));
}

Result<TissueProfile> load_profile(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable table, config::load_toml(file));
  TROCAR_TRY_STATUS(table.check_keys({"name", "note", "force_model", "overrides"}));
  TissueProfile profile;
  TROCAR_TRY(profile.name, table.string("name"));
  TROCAR_TRY_STATUS(check_name(profile.name));
  TROCAR_TRY(profile.note, table.string_or("note", ""));
  TROCAR_TRY(profile.force_model, table.string_or("force_model", ""));
  TROCAR_TRY(profile.overrides, table.strings("overrides"));
  profile.file = file;
  return profile;
}

Status delete_profile(const TissueProfile& profile) {
  std::error_code error;
  std::filesystem::remove(profile.file, error);
  if (error)
    return fail("the profile cannot be deleted: " + error.message(), profile.file.string(),
                "check the permissions of its folder");
  return {};
}

ProfileList list_profiles(const std::filesystem::path& folder) {
  ProfileList list;
  const auto files = list_folder(folder);
  if (!files) return list;
  for (const std::filesystem::path& file : *files) {
    if (file.extension() != ".toml") continue;
    if (auto profile = load_profile(file)) {
      list.profiles.push_back(*std::move(profile));
    } else {
      list.problems.push_back(profile.error().text());
    }
  }
  std::sort(list.profiles.begin(), list.profiles.end(),
            [](const TissueProfile& a, const TissueProfile& b) { return a.name < b.name; });
  return list;
}

Result<anatomy::TissueTable> with_profile(anatomy::TissueTable table, const TissueProfile& profile) {
  for (const std::string& assignment : profile.overrides) TROCAR_TRY_STATUS(anatomy::apply_override(table, assignment));
  return table;
}

}  // namespace trocar::cases
