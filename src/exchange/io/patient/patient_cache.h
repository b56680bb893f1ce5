#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "io/patient/patient_source.h"

namespace trocar::io {

/// Where the programs of this user keep embedded patients.
std::filesystem::path patient_cache_folder();

/// Embedded patients kept as patient folders, with their surfaces or without: loading takes a second, generating many.
/// An entry belongs to one name, one seed, one version of the code that generates patients and its data files
/// (phantom_data_files), since other code or data may generate other patients; all programs of a build share the
/// entries. Entries are written whole or not at all; the least recently used ones are removed.
class PatientCache {
 public:
  static constexpr std::size_t kMostKept = 6;                            ///< Entries.
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;  ///< Of all entries; the newest stays anyway.

  /// An empty folder: keeps and finds nothing.
  explicit PatientCache(std::filesystem::path folder);

  /// The patient folder with surfaces; nothing where it is not kept.
  std::optional<std::filesystem::path> find(const PatientSource& source) const;
  /// The same, with or without surfaces.
  std::optional<std::filesystem::path> find_volumes(const PatientSource& source) const;
  /// Writes an entry; without meshes it has no surfaces. Errors: the disk; no cache; another process was faster.
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
