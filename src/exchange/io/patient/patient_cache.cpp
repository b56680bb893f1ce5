#include "io/patient/patient_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/content_hash.h"
#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "core/files/unfinished_output.h"
#include "core/log.h"
#include "io/patient/detail/maker_version.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "surface/extract_surface.h"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

/// Hash of the code and the data files that generate patients: other ones may generate other patients.
std::string maker_hash() {
  ContentHash hash;
  hash.add(std::as_bytes(std::span(detail::maker_version())));
  for (const fs::path& file : phantom::phantom_data_files())
    if (const auto text = read_input(file, FileKind::kToml)) hash.add(std::as_bytes(std::span(*text)));
  return hash.digest();
}

bool is_embedded(const PatientSource& source) {
  std::error_code ignored;
  const std::string& name = source.folder_or_name;
  return !name.empty() && name.find('/') == std::string::npos && !fs::exists(name, ignored);
}

std::uintmax_t bytes_of(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code ignored;
  const auto files = list_tree(folder, {.skips_unreadable = true});
  if (!files) return bytes;
  for (const fs::path& file : *files) {
    std::error_code gone;
    const std::uintmax_t size = fs::is_regular_file(file, gone) ? fs::file_size(file, gone) : 0;
    if (!gone) bytes += size;
  }
  return bytes;
}

/// Removes the least recently used entries beyond the limits; keeps the newest one.
void drop_oldest(const fs::path& folder) {
  std::error_code ignored;
  std::vector<std::pair<fs::file_time_type, fs::path>> entries;
  const auto listed = list_folder(folder);
  if (!listed) return;
  for (const fs::path& entry : *listed) {
    std::error_code gone;
    const fs::file_time_type time =
        fs::is_directory(entry, gone) ? fs::last_write_time(entry, gone) : fs::file_time_type();
    if (!gone && fs::is_directory(entry, gone)) entries.emplace_back(time, entry);
  }
  std::sort(entries.rbegin(), entries.rend());
  std::uintmax_t bytes = 0;
  for (std::size_t n = 0; n < entries.size(); ++n) {
    bytes += bytes_of(entries[n].second);
    if (n > 0 && (n >= PatientCache::kMostKept || bytes > PatientCache::kMostBytes))
      fs::remove_all(entries[n].second, ignored);
  }
}

/// Returns the entry if it is complete, and marks it as used now.
std::optional<fs::path> use(const fs::path& entry) {
  std::error_code ignored;
  if (!fs::exists(entry / "patient.toml", ignored)) return std::nullopt;
  fs::last_write_time(entry, fs::file_time_type::clock::now(), ignored);
  return entry;
}

}  // namespace

fs::path patient_cache_folder() {
  return user_cache_folder() / "patients";
}

PatientCache::PatientCache(fs::path folder) : folder_(std::move(folder)) {}

bool PatientCache::is_valid(const PatientSource& source) const {
  return !folder_.empty() && is_embedded(source);
}

fs::path PatientCache::folder_of(const PatientSource& source) const {
  return folder_ / fmt::format("{}-{}-{}", source.folder_or_name, source.seed, maker_hash());
}

std::optional<fs::path> PatientCache::find(const PatientSource& source) const {
  return is_valid(source) ? use(folder_of(source)) : std::nullopt;
}

Result<fs::path> PatientCache::keep(const PatientSource& source, const anatomy::VirtualPatient& patient) const {
  if (!is_valid(source))
    return fail("the patient is not cached", source.folder_or_name, "name an embedded patient and a cache folder");
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error)
    return fail("cannot create the cache folder: " + error.message(), folder_.string(),
                "check the permissions of the folder above it");
  fs::path entry = folder_of(source);
  if (const Status saved = save_patient(patient, {}, entry, {}, {}, nullptr, VolumePacking::kFast); !saved) {
    if (use(entry)) return entry;  // written by another process
    return tl::unexpected(saved.error());
  }
  forget_finished_output(entry);
  drop_oldest(folder_);
  return entry;
}

Status PatientCache::keep_surfaces(const PatientSource& source, const std::vector<anatomy::NamedMesh>& meshes) const {
  const auto entry = find(source);
  if (!entry) return fail("the patient is not in the cache", source.folder_or_name, "open the patient again");
  return add_patient_meshes(*entry, meshes);
}

void PatientCache::forget(const PatientSource& source) const noexcept {
  if (!is_valid(source)) return;
  std::error_code ignored;
  fs::remove_all(folder_of(source), ignored);
}

namespace {

/// If the cache cannot be written, the command continues more slowly.
template <class Kept>
void log_if_failed(const Kept& kept) {
  if (!kept) log_info("the patient is not cached: {}", kept.error().text());
}

}  // namespace

Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress) {
  if (source.cache_folder.empty() || is_path(source.folder_or_name)) return load_source(source, progress);
  const PatientCache cache(source.cache_folder);
  if (const auto kept = cache.find(source)) {
    if (auto patient = load_patient(*kept)) return patient;
    cache.forget(source);
  }
  TROCAR_TRY(anatomy::VirtualPatient patient, load_source(source, progress));
  log_if_failed(cache.keep(source, patient));
  return patient;
}

Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient_meshes(source.folder_or_name);
  const PatientCache cache(source.cache_folder);
  if (auto kept = find_kept_meshes(source)) return *std::move(kept);
  auto meshes = surface::extract_surfaces(patient, {}, progress);
  log_if_failed(cache.keep_surfaces(source, meshes));
  return meshes;
}

std::optional<std::vector<anatomy::NamedMesh>> find_kept_meshes(const PatientSource& source) {
  const auto kept = PatientCache(source.cache_folder).find(source);
  if (!kept) return std::nullopt;
  auto meshes = load_patient_meshes(*kept);
  if (!meshes || meshes->empty()) return std::nullopt;
  return *std::move(meshes);
}

}  // namespace trocar::io
