#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "io/patient/patient_folder.h"

namespace trocar::io {

/// Folder in which the programs of this user store embedded patients.
std::filesystem::path patient_cache_folder();

/// Cache of embedded patients as patient folders: reading takes a fraction of a second, generation seconds. Surfaces
/// may be added later. The volumes are not compressed, which would take longer than generating them: 5 bytes per voxel.
/// The key of an entry is its name, its seed, the version of the code that generates patients and its data files
/// (phantom_data_files), because other code or data may generate other patients. All programs of a build share the
/// entries. Entries are written completely or not at all; the least recently used ones are removed.
class PatientCache {
 public:
  static constexpr std::size_t kMostKept = 24;                           ///< Entries.
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;  ///< Of all entries; always keeps the newest.

  /// With an empty `folder`, the cache stores and finds nothing.
  explicit PatientCache(std::filesystem::path folder);

  /// The patient folder, with or without surfaces; empty if there is no entry.
  std::optional<std::filesystem::path> find(const PatientSource& source) const;
  /// Writes an entry without surfaces. Errors: disk error, no cache folder. An entry that another process has written
  /// in the meantime is kept.
  Result<std::filesystem::path> keep(const PatientSource& source, const anatomy::VirtualPatient& patient) const;
  /// Adds the surfaces to an entry. Errors: disk error, no entry.
  Status keep_surfaces(const PatientSource& source, const std::vector<anatomy::NamedMesh>& meshes) const;
  /// Removes a damaged entry.
  void forget(const PatientSource& source) const noexcept;

 private:
  std::filesystem::path folder_of(const PatientSource& source) const;
  bool is_valid(const PatientSource& source) const;
  std::filesystem::path folder_;
};

/// Loads the patient of a source with the source's cache: an embedded patient is stored in the cache and read from it.
/// The patient is identical with and without the cache. Errors: those of load_source().
Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress = {});
/// Surfaces of the patient: read from its folder, or extracted from the labels of an embedded patient.
Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress = {});

/// Surfaces of an embedded patient in its cache; empty if it has none there.
std::optional<std::vector<anatomy::NamedMesh>> find_kept_meshes(const PatientSource& source);

}  // namespace trocar::io
