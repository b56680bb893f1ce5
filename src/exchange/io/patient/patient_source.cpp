#include "io/patient/patient_source.h"

#include <algorithm>
#include <filesystem>

#include "anatomy/phantom/phantom.h"
#include "core/files/list_folder.h"
#include "io/patient/detail/patient_toml.h"
#include "io/patient/patient_folder.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kMostFolders = 256;  // number of folders searched next to a session

bool has_hash(const fs::path& folder, const std::string& hash) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / "patient.toml", ignored)) return false;
  const auto description = detail::load_patient_toml(folder / "patient.toml", folder);
  return description && description->content_hash == hash;
}

/// The recorded path and its possible new locations, best first.
std::vector<fs::path> candidates(const fs::path& recorded, const fs::path& beside) {
  std::vector<fs::path> folders{recorded};
  if (recorded.is_relative()) folders.push_back(beside / recorded);
  const fs::path name = recorded.has_filename() ? recorded.filename() : recorded.parent_path().filename();
  folders.push_back(beside / name);
  std::vector<fs::path> neighbours = list_folder(beside).value_or(std::vector<fs::path>());
  std::erase_if(neighbours, [](const fs::path& entry) {
    std::error_code gone;
    return !fs::is_directory(entry, gone);
  });
  if (neighbours.size() > kMostFolders) neighbours.resize(kMostFolders);
  folders.insert(folders.end(), neighbours.begin(), neighbours.end());
  return folders;
}

}  // namespace

bool is_path(const std::string& folder_or_name) {
  std::error_code ignored;
  return folder_or_name.find('/') != std::string::npos || fs::exists(folder_or_name, ignored);
}

std::string absolute_source(const std::string& folder_or_name) {
  std::error_code ignored;
  if (!fs::is_directory(folder_or_name, ignored)) return folder_or_name;
  return fs::absolute(folder_or_name, ignored).lexically_normal().string();
}

Result<std::string> find_recorded_patient(const std::string& recorded, const std::string& hash,
                                          const fs::path& beside) {
  if (recorded.empty()) return fail("the record does not name its patient", beside.string(), "name it with --patient");
  const fs::path folder = beside.empty() ? fs::path(".") : beside;
  for (const fs::path& candidate : candidates(recorded, folder))
    if (has_hash(candidate, hash)) return absolute_source(candidate.string());
  std::error_code ignored;
  if (recorded.find('/') == std::string::npos || fs::is_directory(recorded, ignored)) return recorded;
  return fail("patient folder not found, and no folder with the same content near the session", recorded,
              "name it with --patient");
}

Result<anatomy::VirtualPatient> load_source(const PatientSource& source, const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient(source.folder_or_name);
  TROCAR_TRY(anatomy::VirtualPatient patient,
             anatomy::generate_phantom(source.folder_or_name, source.seed, {}, progress));
  round_as_saved(patient);
  return patient;
}

}  // namespace trocar::io
