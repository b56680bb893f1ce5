#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"

namespace trocar::cases {

/// Numbers of tissues that a user fitted to a patient, with a name: the differences from the table.
struct TissueProfile {
  std::string name;  ///< As the user wrote it; 1 to 80 characters.
  std::string note;
  std::string force_model;             ///< Empty: the task's.
  std::vector<std::string> overrides;  ///< "liver.k=0.5", in the form of apply_override.
  std::filesystem::path file = {};     ///< File from which it was loaded; saving uses only the name.
};

/// File of a profile in a folder: its name, with replacements for characters that file systems do not allow.
std::filesystem::path profile_file(const std::filesystem::path& folder, const std::string& name);
/// Writes a profile as TOML, completely or not at all; makes the folder. Errors: an invalid name, overrides that the
/// table rejects (exit status 2), an existing profile of that name if `may_replace` is false (exit status 2), the disk.
Status save_profile(const TissueProfile& profile, const anatomy::TissueTable& table,
                    const std::filesystem::path& folder, bool may_replace);
/// Errors name file, line and key.
Result<TissueProfile> load_profile(const std::filesystem::path& file);
/// Removes the file from which it was loaded. Error: the disk.
Status delete_profile(const TissueProfile& profile);
/// All profiles of a folder, by name; empty if there is no folder. Unreadable files are left out and named in
/// `problems`.
struct ProfileList {
  std::vector<TissueProfile> profiles;
  std::vector<std::string> problems;
};
ProfileList list_profiles(const std::filesystem::path& folder);
/// The table with the profile's numbers. Errors: a number that the table rejects.
Result<anatomy::TissueTable> with_profile(anatomy::TissueTable table, const TissueProfile& profile);

}  // namespace trocar::cases
