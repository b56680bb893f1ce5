#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "io/patient/patient_source.h"

namespace trocar::io {

/// Folder in which the programs of this user store embedded patients.
std::filesystem::path patient_cache_folder();

/// Cache of embedded patients as patient folders, with or without surfaces: loading takes a second, generation many.
/// The key of an entry is its name, its seed, the version of the code that generates patients and its data files
/// (phantom_data_files), because other code or data may generate other patients. All programs of a build share the
/// entries. Entries are written completely or not at all; the least recently used ones are removed.
class PatientCache {
 public:
  static constexpr std::size_t kMostKept = 6;                            ///< Entries.
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;  ///< Of all entries; always keeps the newest.

  /// With an empty `folder`, the cache stores and finds nothing.
  explicit PatientCache(std::filesystem::path folder);

  /// The patient folder with surfaces; empty if there is no entry.
  std::optional<std::filesystem::path> find(const PatientSource& source) const;
  /// The same, with or without surfaces.
  std::optional<std::filesystem::path> find_volumes(const PatientSource& source) const;
  /// Writes an entry; without meshes it has no surfaces. Errors: disk error, no cache folder, another process has
  /// written the entry first.
  Result<std::filesystem::path> keep(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                     const std::vector<anatomy::NamedMesh>& meshes) const;
  /// Removes damaged entries.
  void forget(const PatientSource& source) const noexcept;

 private:
  std::filesystem::path folder_of(const PatientSource& source, bool has_surfaces) const;
  bool is_valid(const PatientSource& source) const;
  std::filesystem::path folder_;
};

}  // namespace trocar::io
