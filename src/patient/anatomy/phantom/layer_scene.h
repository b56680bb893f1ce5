#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/phantom/layer_data.h"
#include "anatomy/phantom/shapes.h"

namespace trocar::anatomy::phantom {

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

}  // namespace trocar::anatomy::phantom
