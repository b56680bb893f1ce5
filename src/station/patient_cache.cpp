#include "station/patient_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "io/patient_folder.h"

namespace trocar {
namespace {

namespace fs = std::filesystem;

/// Of the running program: what it makes is its own. Empty where it cannot be read.
const std::string& build_hash() {
  static const std::string kHash = [] {
    const auto program = read_file("/proc/self/exe");
    if (!program) return std::string();
    ContentHash hash;
    hash.add(std::as_bytes(std::span(*program)));
    return hash.digest();
  }();
  return kHash;
}

bool is_embedded(const PatientSource& source) {
  std::error_code ignored;
  const std::string& name = source.folder_or_name;
  return !name.empty() && name.find('/') == std::string::npos && !fs::exists(name, ignored);
}

void drop_oldest(const fs::path& folder, std::size_t most) {
  std::error_code ignored;
  std::vector<std::pair<fs::file_time_type, fs::path>> kept;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_directory(ignored)) kept.emplace_back(entry.last_write_time(ignored), entry.path());
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i + most < kept.size(); ++i) fs::remove_all(kept[i].second, ignored);
}

}  // namespace

PatientCache::PatientCache(fs::path folder) : folder_(std::move(folder)) {}

fs::path PatientCache::folder_of(const PatientSource& source) const {
  return folder_ / fmt::format("{}-{}-{}", source.folder_or_name, source.seed, build_hash());
}

std::optional<fs::path> PatientCache::find(const PatientSource& source) const {
  if (folder_.empty() || build_hash().empty() || !is_embedded(source)) return std::nullopt;
  std::error_code ignored;
  fs::path folder = folder_of(source);
  if (!fs::exists(folder / "patient.toml", ignored)) return std::nullopt;
  return folder;
}

Result<fs::path> PatientCache::keep(const PatientSource& source, const VirtualPatient& patient,
                                    const std::vector<NamedMesh>& meshes) const {
  if (folder_.empty() || build_hash().empty() || !is_embedded(source)) return fail("the patient is not to be kept");
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return fail("the folder cannot be made: " + error.message(), folder_.string());
  drop_oldest(folder_, kMostKept - 1);
  const fs::path folder = folder_of(source);
  TROCAR_TRY_STATUS(save_patient(patient, meshes, folder));
  return folder;
}

void PatientCache::forget(const PatientSource& source) const noexcept {
  std::error_code ignored;
  if (const auto folder = find(source)) fs::remove_all(*folder, ignored);
}

}  // namespace trocar
