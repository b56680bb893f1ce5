#include "io/patient/detail/patient_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace trocar::io::detail {
namespace {
namespace fs = std::filesystem;

constexpr float kDistanceUnit_mm = 0.01F;
constexpr std::size_t kDistancesAtOnce = std::size_t{1} << 18;

}  // namespace

Result<PatientDescription> load_description(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail("no such patient folder", folder.string(), "build one with trocar patient build");
  if (!fs::exists(folder / kDescriptionFile, error))
    return fail("not a patient folder: it has no patient.toml", folder.string(), "build one with trocar patient build");
  return load_patient_toml(folder / kDescriptionFile, folder);
}

volume::CtGrid to_hundredths(const volume::FloatGrid& distance_mm) {
  volume::CtGrid hundredths;
  hundredths.geometry = distance_mm.geometry;
  hundredths.voxels.resize(distance_mm.voxels.size());
  parallel_for(distance_mm.voxels.size(), kDistancesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      hundredths.voxels[n] = static_cast<std::int16_t>(
          std::lround(std::clamp(distance_mm.voxels[n] / kDistanceUnit_mm, -32767.0F, 32767.0F)));
  });
  return hundredths;
}

volume::FloatGrid from_hundredths(const volume::CtGrid& hundredths) {
  volume::FloatGrid distance_mm;
  distance_mm.geometry = hundredths.geometry;
  distance_mm.voxels.resize(hundredths.voxels.size());
  parallel_for(hundredths.voxels.size(), kDistancesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      distance_mm.voxels[n] = kDistanceUnit_mm * static_cast<float>(hundredths.voxels[n]);
  });
  return distance_mm;
}

Status check_label_ids(const anatomy::VirtualPatient& patient, const std::string& where) {
  std::array<bool, 256> occurs{};
  for (const std::uint8_t id : patient.labels.voxels) occurs[id] = true;
  for (std::size_t id = 1; id < occurs.size(); ++id)
    if (occurs[id] && patient.label_table.find(static_cast<std::uint8_t>(id)) == nullptr)
      return fail(fmt::format("the label volume has the value {}, which is not in the label table", id), where,
                  kBuildAgain);
  return {};
}

Status check_geometry(const anatomy::VirtualPatient& patient, const std::string& where) {
  const volume::GridGeometry& g = patient.ct.geometry;
  if (g.matches(patient.labels.geometry) && g.matches(patient.skin_distance_mm.geometry)) return {};
  return fail("CT, labels and skin distance are not on the same grid", where, kBuildAgain);
}

}  // namespace trocar::io::detail
