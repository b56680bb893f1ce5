#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "phantom/phantom_data.h"
#include "phantom/shapes.h"

// The numbers of data/phantoms/layers.toml: depths below the skin on the expert path, x and z as in P, all in mm. The
// file describes each of them and gives the sources.
namespace trocar::phantom {

struct CoverLayers {
  float skin, bone_cortex;
};

struct LumbarLayers {
  float supraspinous, interspinous, flavum, epidural, dura, sac_end, canal_end;
  float target_behind_dura;
  float supraspinous_half_width, flavum_end, canal_half_width, sac_half_width;
  Ellipse body;
  float disc_half_height, gap_half;
  float spinous_half_width, spinous_end, spinous_top;
  float lamina, lamina_end, lamina_top;
  float pedicle_x, pedicle_half_width;
  std::array<float, 2> pedicle_depths;
  float pedicle_z, pedicle_half_height;
  float facet_x, facet_depth, facet_radius, facet_gap_half;
  float erector_x;
  std::array<float, 2> erector_depths;
  float psoas_x;
  std::array<float, 2> psoas_depths;
};

struct AscitesLayers {
  float muscle, muscle_end, peritoneum, bowel;
  float fluid_behind_bowel, psoas;
  float loop_radius, loop_wall, loop_z;
  std::array<float, 2> gas_loops_z;
  float gas;
};

struct LiverLayers {
  float muscle, peritoneum, capsule, end;
  float duct, duct_radius, vein, vein_radius;
  float rib_depth, rib_z, rib_radius;
};

struct LayerData {
  CoverLayers cover;
  LumbarLayers lumbar;
  AscitesLayers ascites;
  LiverLayers liver;
};

/// File in the data folder.
inline constexpr std::string_view kLayersFile = "phantoms/layers.toml";

/// Reads data/phantoms/layers.toml. Errors as load_abdomen_data; layers on the path that are not in order of depth.
Result<LayerData> load_layer_data(const std::filesystem::path& path);

/// One object of a layered scene in its own coordinates: x as in P, depth below the skin, z as in P. Later shapes cover
/// earlier ones.
struct LayerShape {
  std::string_view name;  ///< A known structure.
  float hu = 0.0F;
  float texture_hu = 0.0F;
  std::function<float(float x, float depth, float z)> distance;  ///< mm, negative inside.
};

struct LayerScene {
  std::vector<LayerShape> shapes;
  bool is_from_back = false;   ///< true: the skin faces +y; false: -y.
  float target_mm = 0.0F;      ///< Depth of the expert path's target, at x = z = 0.
  std::string_view path_name;  ///< Name of the expert path.
};

LayerScene lumbar_scene(const LayerData& data);
LayerScene ascites_scene(const LayerData& data);
LayerScene liver_scene(const LayerData& data);

}  // namespace trocar::phantom
