#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geometry/shapes.h"
#include "image/image.h"

namespace trocar::scene {

/// Shape of hub and tip of a needle.
enum class NeedleModel {
  kChiba,      ///< Thin, small hub with marks every 10 mm, bevelled tip.
  kTuohy,      ///< Winged hub, tip curved to the side.
  kQuincke,    ///< Slim hub with a stylet's cap, sharp bevel.
  kBiopsyGun,  ///< Box with a cocking slide; bevelled stylet with the specimen notch behind its tip.
  kTrocar,     ///< Ball handle, stout cannula with a collar, three-sided point.
};

/// Model of a name in data/needles.toml ("trocar"); an unknown name is a Chiba needle.
NeedleModel needle_model(std::string_view name) noexcept;

/// A closed part of a tool with its own colour, in the frame of the points it was made from.
struct ShapePart {
  TriangleMesh mesh;
  image::Rgb color{200, 200, 200};
  double specular = 0.5;  ///< 0..1
};

/// A needle along a shaft from the hub to the tip (at least two points, mm): the shaft with its tip, then the hub,
/// which lies before the shaft's first point. `diameter_mm` is the true diameter; the shaft is drawn with at least
/// `least_diameter_mm`, so that it is visible from a distance. Hubs have their true size.
std::vector<ShapePart> make_needle_shape(std::span<const Vec3> shaft, double diameter_mm, NeedleModel model,
                                         double least_diameter_mm = 0.0);

/// A round tube along a polyline, closed at both ends, with outward normals.
TriangleMesh make_tube(std::span<const Vec3> line, double radius_mm, int sides = 16);
/// A sphere.
TriangleMesh make_ball(const Vec3& center, double radius_mm);

/// Scan parameters that determine the outer shape of a transducer.
struct TransducerFace {
  bool is_convex = true;
  double radius_mm = 60.0;         ///< Radius of the array's arc; convex only, 0 for a phased array.
  double field_of_view_rad = 1.2;  ///< Angle between the outermost scanlines; convex only.
  double width_mm = 40.0;          ///< Width of a flat face.
  double least_width_mm = 16.0;    ///< Minimum face width of a phased array.
};

/// A transducer's housing in its frame T (x lateral, y into the body, z elevation): lens, body, handle and the start of
/// the cable, with a raised mark on the side of +x. The face's middle is at the origin.
std::vector<ShapePart> make_transducer_shape(const TransducerFace& face);

}  // namespace trocar::scene
