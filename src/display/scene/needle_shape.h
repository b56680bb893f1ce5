#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "volume/image.h"

namespace trocar::scene {

/// What a needle looks like at both ends.
enum class NeedleModel {
  kChiba,      ///< Thin, small hub with marks every 10 mm, bevelled tip.
  kTuohy,      ///< Winged hub, tip curved to the side.
  kQuincke,    ///< Slim hub with a stylet's cap, sharp bevel.
  kBiopsyGun,  ///< Box with a cocking slide; bevelled stylet with the specimen notch behind its tip.
  kTrocar,     ///< Ball handle, stout cannula with a collar, three-sided point.
};

/// By its name in data/needles.toml ("trocar"); a name that is none is a Chiba needle.
NeedleModel needle_model(std::string_view name) noexcept;

/// A closed part of a tool with its own colour, in the frame of the points it was made from.
struct ShapePart {
  TriangleMesh mesh;
  volume::Rgb color{200, 200, 200};
  double specular = 0.5;  ///< 0..1
};

/// A needle along a shaft from the hub to the tip (at least two points, mm): the shaft with its tip, then the hub,
/// which lies before the shaft's first point. `diameter_mm` is the true one; the shaft is drawn no thinner than
/// `least_diameter_mm`, so that it can be seen from far. Hubs have their true size.
std::vector<ShapePart> make_needle_shape(std::span<const Vec3> shaft, double diameter_mm, NeedleModel model,
                                         double least_diameter_mm = 0.0);

/// A round tube along a line of points, closed at both ends, with normals outward.
TriangleMesh make_tube(std::span<const Vec3> line, double radius_mm, int sides = 16);
/// A ball.
TriangleMesh make_ball(const Vec3& center, double radius_mm);

}  // namespace trocar::scene
