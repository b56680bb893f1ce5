#pragma once

#include <vtkPlane.h>

#include <vector>

#include "scene/detail/drawing.h"

namespace trocar::scene::detail {

/// A surface that is drawn during motion.
struct CoarsePart {
  vtkSmartPointer<vtkPolyData> data;  ///< With normals.
  image::Rgb color;
  double opacity = 1.0;
};

/// Surfaces for rendering on the processor: all opaque surfaces are one mesh, and the translucent ones are blended over
/// it from the smallest to the largest, in a single pass with a one-line lighting model.
class CoarseSurfaces {
 public:
  explicit CoarseSurfaces(vtkRenderer& renderer) : renderer_(renderer) {}

  void set_parts(const std::vector<CoarsePart>& parts);
  void set_visible(bool is_visible);
  /// Clips the surfaces with the plane; nullptr: no clipping.
  void set_cut(vtkPlane* cut);
  /// Moves them to the end of the drawing order, as required for blending.
  void draw_last();

 private:
  void add(vtkPolyData* data, const image::Rgb& color, double opacity, bool has_colors);

  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;  ///< In drawing order.
  vtkSmartPointer<vtkPlane> cut_;
  bool is_visible_ = false;
};

}  // namespace trocar::scene::detail
