#pragma once

#include "scene/needle_shape.h"

namespace trocar::scene {

/// What of a transducer's scan shows on its outside.
struct TransducerFace {
  bool is_convex = true;
  double radius_mm = 60.0;         ///< Of the array's arc; convex only, 0 for a phased array.
  double field_of_view_rad = 1.2;  ///< Between the outermost scanlines; convex only.
  double width_mm = 40.0;          ///< Of a flat face.
  double least_width_mm = 16.0;    ///< A phased array's face is at least so wide.
};

/// A transducer's housing in its frame T (x lateral, y into the body, z elevation): lens, body, handle and the start of
/// the cable, with a raised mark on the side of +x. The face's middle is at the origin.
std::vector<ShapePart> make_transducer_shape(const TransducerFace& face);

}  // namespace trocar::scene
