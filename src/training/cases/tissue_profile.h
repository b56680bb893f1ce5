#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"

namespace trocar::cases {

/// Numbers of tissues that somebody fitted to a patient, under a name of its own: what differs from the table.
struct TissueProfile {
  std::string name;  ///< As the user wrote it; 1 to 80 characters.
  std::string note;
  std::string force_model;             ///< Empty: the task's.
  std::vector<std::string> overrides;  ///< "liver.k=0.5", as apply_override takes them.
  std::filesystem::path file = {};     ///< That it was loaded from; saving looks at the name only.
};

/// The file of a profile in a folder: its name with what file systems do not take replaced.
std::filesystem::path profile_file(const std::filesystem::path& folder, const std::string& name);
/// Writes it as TOML, whole or not at all; makes the folder. Errors: a name that cannot be used, overrides that the
/// table does not take (exit status 2), a profile of that name where `may_replace` is false (exit status 2), the disk.
Status save_profile(const TissueProfile& profile, const anatomy::TissueTable& table,
                    const std::filesystem::path& folder, bool may_replace);
/// Errors name file, line and key.
Result<TissueProfile> load_profile(const std::filesystem::path& file);
/// Removes the file that it was loaded from. Error: the disk.
Status delete_profile(const TissueProfile& profile);
/// All profiles of a folder, by name; none where there is no folder. What cannot be read is left out and named in
/// `problems`.
struct ProfileList {
  std::vector<TissueProfile> profiles;
  std::vector<std::string> problems;
};
ProfileList list_profiles(const std::filesystem::path& folder);
/// The table with the profile's numbers. Errors: a number that the table does not take.
Result<anatomy::TissueTable> with_profile(anatomy::TissueTable table, const TissueProfile& profile);

}  // namespace trocar::cases
