#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "io/patient_source.h"

namespace trocar {

/// Embedded patients kept as patient folders with their surfaces: read in a second what takes many to make. What
/// another build of the program has kept is not used, for it may make other patients.
class PatientCache {
 public:
  static constexpr std::size_t kMostKept = 4;  ///< Folders; the oldest go. About 100 MB each.

  /// An empty folder: keeps and finds nothing.
  explicit PatientCache(std::filesystem::path folder);

  /// The folder of that patient; nothing where it is not kept.
  std::optional<std::filesystem::path> find(const PatientSource& source) const;
  /// Writes it, whole or not at all. Errors: the disk; no cache.
  Result<std::filesystem::path> keep(const PatientSource& source, const VirtualPatient& patient,
                                     const std::vector<NamedMesh>& meshes) const;
  /// What turned out to be damaged.
  void forget(const PatientSource& source) const noexcept;

 private:
  std::filesystem::path folder_of(const PatientSource& source) const;
  std::filesystem::path folder_;
};

}  // namespace trocar
