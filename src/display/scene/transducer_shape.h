#pragma once

#include "scene/needle_shape.h"

namespace trocar::scene {

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
