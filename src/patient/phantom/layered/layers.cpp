#include "phantom/layered/layers.h"

#include <algorithm>
#include <cmath>

#include "anatomy/known_structures.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "core/random.h"
#include "phantom/cases.h"
#include "phantom/layered/layer_scene.h"
#include "phantom/render.h"
#include "phantom/structure.h"

namespace trocar::phantom {
namespace {

const Vec3 kHalfBox(40.0, 70.0, 40.0);
constexpr double kVoxel_mm = 0.8;
constexpr float kSkinY = 45.0F;  ///< The skin is 25 mm inside the box, with air in front.
constexpr float kTexture_mm = 6.0F;
constexpr double kPsfSigma_mm =
    0.7;  ///< Together with the voxel, an edge as wide as that of a CT with a soft kernel, FWHM 1.8 mm. [assumed]

volume::GridGeometry scene_geometry(const PhantomResolution& resolution) {
  volume::GridGeometry geometry;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double extent_mm = 2.0 * kHalfBox[axis];
    geometry.size[a] = resolution.size[a] > 0 ? resolution.size[a] : std::llround(extent_mm / kVoxel_mm);
    geometry.spacing_mm[axis] = extent_mm / static_cast<double>(geometry.size[a]);
    geometry.origin_P[axis] = 0.5 * geometry.spacing_mm[axis] - kHalfBox[axis];
  }
  return geometry;
}

/// Labels of the scene's shapes in their order, one per name.
struct ShapeLabels {
  anatomy::LabelTable table;
  std::vector<std::uint8_t> ids;  ///< By shape.

  static Result<ShapeLabels> make(const LayerScene& scene, const anatomy::KnownStructures& known) {
    ShapeLabels labels;
    for (const LayerShape& shape : scene.shapes) {
      if (labels.table.find(shape.name) == nullptr) {
        const anatomy::KnownStructure* structure = known.find(shape.name);
        if (structure == nullptr)
          return fail("the structure \"" + std::string(shape.name) + "\" of a layered scene is not known", known.file(),
                      "add the name to an entry [[structures]]");
        const auto id = static_cast<std::uint8_t>(labels.table.labels.size() + 1);
        labels.table.labels.push_back({id, std::string(shape.name), structure->tissue, structure->color});
      }
      labels.ids.push_back(labels.table.find(shape.name)->id);
    }
    return labels;
  }
};

float depth_at(const LayerScene& scene, double y) {
  return kSkinY + (scene.is_from_back ? -1.0F : 1.0F) * static_cast<float>(y);
}

/// Renders the scene with partial volume at borders: HU, labels, distance to the skin.
void paint(const LayerScene& scene, const ShapeLabels& labels, std::uint64_t seed, volume::FloatGrid& hu,
           anatomy::VirtualPatient& patient) {
  const volume::GridGeometry& geometry = hu.geometry;
  const ValueNoise noise(seed);
  const auto voxel_mm = static_cast<float>(std::cbrt(geometry.voxel_volume_mm3()));
  parallel_for(hu.voxels.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const volume::Index3 ijk = geometry.index_of(n);
      const Vec3f p = geometry.centre_mm(ijk).cast<float>();
      const float depth = depth_at(scene, p.y());
      const float texture = noise.fractal(p, kTexture_mm);
      float value = kAirHu;
      std::uint8_t label = 0;
      for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        const LayerShape& shape = scene.shapes[s];
        const float distance = shape.distance(p.x(), depth, p.z());
        const float cover = clamp01(0.5F - distance / voxel_mm);
        if (cover > 0.0F) value = mix(value, shape.hu + shape.texture_hu * texture, cover);
        if (distance <= 0.0F) label = labels.ids[s];  // inclusive, so that touching slabs leave no gap
      }
      hu.voxels[n] = value;
      patient.labels.voxels[n] = depth > 0.0F ? label : 0;
      patient.skin_distance_mm.voxels[n] = -depth;
    }
  });
}

/// A Gaussian along one axis; the end values continue outside.
void blur_along(volume::FloatGrid& grid, std::size_t axis, double sigma_mm) {
  const volume::GridGeometry& geometry = grid.geometry;
  const double sigma = sigma_mm / geometry.spacing_mm[static_cast<Eigen::Index>(axis)];
  const auto reach = static_cast<std::int64_t>(std::ceil(3.0 * sigma));
  std::vector<float> kernel;
  for (std::int64_t step = -reach; step <= reach; ++step) {
    const double u = static_cast<double>(step) / sigma;
    kernel.push_back(static_cast<float>(std::exp(-0.5 * u * u)));
  }
  float sum = 0.0F;
  for (const float weight : kernel) sum += weight;
  const std::vector<float> before = grid.voxels;
  parallel_for(before.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      volume::Index3 ijk = geometry.index_of(n);
      const std::int64_t middle = ijk[axis];
      float value = 0.0F;
      for (std::size_t k = 0; k < kernel.size(); ++k) {
        ijk[axis] = std::clamp<std::int64_t>(middle + static_cast<std::int64_t>(k) - reach, 0, geometry.size[axis] - 1);
        value += kernel[k] * before[geometry.offset(ijk)];
      }
      grid.voxels[n] = value / sum;
    }
  });
}

}  // namespace

const std::vector<PhantomInfo>& layered_scenes() {
  static const std::vector<PhantomInfo> kScenes{
      {"layers-lumbar", "layered test scene: lumbar puncture from the back, between two spinous processes", {}},
      {"layers-ascites", "layered test scene: ascites behind the left lower abdominal wall, bowel behind it", {}},
      {"layers-liver", "layered test scene: liver behind the chest wall, with a bile duct and a vein", {}}};
  return kScenes;
}

Result<anatomy::VirtualPatient> make_layered_scene(std::string_view name, std::uint64_t seed,
                                                   const PhantomResolution& resolution) {
  const auto& scenes = layered_scenes();
  const auto info = std::find_if(scenes.begin(), scenes.end(), [&](const PhantomInfo& i) { return i.name == name; });
  if (info == scenes.end()) return fail_usage("unknown layered scene", std::string(name), "see trocar patient list");
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(const LayerData data, load_layer_data(data_folder / kLayersFile));
  const LayerScene scene = name == "layers-lumbar"    ? lumbar_scene(data)
                           : name == "layers-ascites" ? ascites_scene(data)
                                                      : liver_scene(data);
  TROCAR_TRY(const anatomy::KnownStructures known, anatomy::KnownStructures::load(data_folder));
  TROCAR_TRY(const ShapeLabels labels, ShapeLabels::make(scene, known));
  const volume::GridGeometry geometry = scene_geometry(resolution);
  const std::uint64_t mixed_seed = mix64(seed);

  anatomy::VirtualPatient patient;
  patient.name = info->name;
  patient.description = info->description;
  patient.provenance = {"generated: embedded patient \"" + info->name + "\", seed " + std::to_string(seed)};
  patient.label_table = labels.table;
  patient.labels = volume::LabelGrid(geometry);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  volume::FloatGrid hu(geometry);
  paint(scene, labels, mixed_seed, hu, patient);
  for (std::size_t axis = 0; axis < 3; ++axis) blur_along(hu, axis, kPsfSigma_mm);
  patient.ct = volume::CtGrid(geometry);
  std::transform(hu.voxels.begin(), hu.voxels.end(), patient.ct.voxels.begin(),
                 [](float value) { return static_cast<std::int16_t>(std::lround(value)); });
  add_scanner_noise(patient.ct, patient.skin_distance_mm, mixed_seed, BodyParameters{}.noise_hu);

  const double inwards = scene.is_from_back ? -1.0 : 1.0;
  const Vec3 entry_P(0.0, -inwards * static_cast<double>(kSkinY), 0.0);
  const Vec3 target_P = entry_P + Vec3(0.0, inwards * static_cast<double>(scene.target_mm), 0.0);
  patient.landmarks = {{"entry", entry_P}};
  patient.paths = {{std::string(scene.path_name), {entry_P, target_P}}};
  patient.content_hash = anatomy::hash_patient(patient);
  return patient;
}

}  // namespace trocar::phantom
