#include "anatomy/phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "anatomy/phantom/abdomen.h"
#include "anatomy/phantom/layer_data.h"
#include "anatomy/phantom/layers.h"
#include "anatomy/phantom/render.h"
#include "core/files/data_dir.h"

namespace trocar::anatomy {
namespace {

using namespace phantom;

constexpr volume::Index3 kDefaultSize{380, 300, 240};
constexpr std::int64_t kLeastSize = 16;
constexpr std::int64_t kGreatestSize = 1024;

/// The phantom's box divided into voxels; the box is the same for every resolution.
volume::GridGeometry box_geometry(const PhantomResolution& resolution) {
  volume::GridGeometry geometry;
  const Vec3 extent = 2.0 * Vec3(kHalfWidth, kHalfDepth, kHalfHeight);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto a = static_cast<Eigen::Index>(n);
    geometry.size[n] = resolution.size[n] > 0 ? resolution.size[n] : kDefaultSize[n];
    geometry.spacing_mm[a] = extent[a] / static_cast<double>(geometry.size[n]);
    geometry.origin_P[a] = 0.5 * (geometry.spacing_mm[a] - extent[a]);
  }
  return geometry;
}

Status check_resolution(const PhantomResolution& resolution) {
  for (const std::int64_t size : resolution.size) {
    if (size != 0 && (size < kLeastSize || size > kGreatestSize))
      return fail_usage("a phantom of " + std::to_string(size) + " voxels along one axis cannot be made", "resolution",
                        "choose 16 to 1024 voxels, or 0 for the default");
  }
  return {};
}

std::vector<Landmark> landmarks(const Anatomy& anatomy) {
  const auto& contours = anatomy.torso.contours();
  const LandmarkData& data = anatomy.data.landmarks;
  const SpineData& spine = anatomy.data.spine;
  const auto on_skin = [&](float phi, float z) -> Vec3 {
    const double r = contours.skin_radius(phi, z);
    return {r * std::sin(phi), r * std::cos(phi), z};
  };
  constexpr int kT10 = 5, kT12 = 7, kL3 = 10;
  constexpr float kFront = std::numbers::pi_v<float>;
  return {{"xiphoid", on_skin(kFront, data.xiphoid_z_mm)},
          {"umbilicus", on_skin(kFront, anatomy.data.torso.umbilicus_z_mm)},
          {"spinous process T12", on_skin(0.0F, spine.height(kT12) - data.t12_spinous_below_mm)},
          {"spinous process L3", on_skin(0.0F, spine.height(kL3) - data.l3_spinous_below_mm)},
          {"right mid-axillary line, tenth rib",
           on_skin(-0.5F * kFront, spine.height(kT10) - data.tenth_rib_below_t10_mm)}};
}

Result<VirtualPatient> generate_abdomen(const PhantomInfo& info, std::uint64_t seed,
                                        const PhantomResolution& resolution, const Progress& progress) {
  const volume::GridGeometry geometry = box_geometry(resolution);
  report(progress, "generating the anatomy", 0.0);
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(KnownStructures known, KnownStructures::load(data_folder));
  TROCAR_TRY(AbdomenData data, load_abdomen_data(data_folder / kAbdomenFile));
  Anatomy anatomy(seed, std::move(data), std::move(known));
  TROCAR_TRY(BiopsyPlan plan, build_abdomen(anatomy));

  Rendering rendering = render(anatomy, geometry, progress);
  VirtualPatient patient;
  patient.name = info.name;
  patient.description = info.description;
  patient.provenance = {"generated: embedded patient \"" + info.name + "\", seed " + std::to_string(seed)};
  patient.ct = std::move(rendering.ct);
  patient.labels = std::move(rendering.labels);
  patient.skin_distance_mm = std::move(rendering.skin_distance_mm);
  patient.label_table = std::move(anatomy.label_table);
  patient.landmarks = landmarks(anatomy);
  patient.paths = {std::move(plan.path)};
  patient.content_hash = hash_patient(patient);
  return patient;
}

}  // namespace

const std::vector<PhantomInfo>& embedded_patients() {
  static const std::vector<PhantomInfo> kPatients = [] {
    std::vector<PhantomInfo> patients{
        {"abdomen", "upper abdomen in the portal-venous phase with three liver lesions, generated", {"liver-biopsy"}}};
    patients.insert(patients.end(), layered_scenes().begin(), layered_scenes().end());
    return patients;
  }();
  return kPatients;
}

std::vector<std::filesystem::path> phantom_data_files() {
  const std::filesystem::path folder = data_dir();
  return {folder / kStructuresFile, folder / kAbdomenFile, folder / kLayersFile};
}

Result<VirtualPatient> generate_phantom(std::string_view name, std::uint64_t seed, const PhantomResolution& resolution,
                                        const Progress& progress) {
  const auto& patients = embedded_patients();
  const auto found =
      std::find_if(patients.begin(), patients.end(), [&](const PhantomInfo& i) { return i.name == name; });
  if (found == patients.end()) {
    std::string names;
    for (const PhantomInfo& patient : patients) names += (names.empty() ? "" : ", ") + patient.name;
    return fail_usage("unknown embedded patient \"" + std::string(name) + "\"", {}, "there are: " + names);
  }
  TROCAR_TRY_STATUS(check_resolution(resolution));
  if (found != patients.begin()) return make_layered_scene(name, seed, resolution);
  return generate_abdomen(*found, seed, resolution, progress);
}

}  // namespace trocar::anatomy
