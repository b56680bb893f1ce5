#pragma once

#include <vtkPlane.h>

#include <vector>

#include "scene/detail/drawing.h"

namespace trocar::scene::detail {

/// A surface as it is drawn while things move.
struct MovingPart {
  vtkSmartPointer<vtkPolyData> data;  ///< With normals.
  volume::Rgb color;
  double opacity = 1.0;
};

/// The surfaces for a processor without a graphics card: all opaque ones in one piece, the translucent ones blended
/// over it from the smallest to the largest, in a single pass and a light of one line.
class MovingSurfaces {
 public:
  explicit MovingSurfaces(vtkRenderer& renderer) : renderer_(renderer) {}

  void set_parts(const std::vector<MovingPart>& parts);
  void set_visible(bool is_visible);
  /// Leaves out what the plane cuts off; nullptr: nothing.
  void set_cut(vtkPlane* cut);
  /// Puts them behind all others in the order of drawing, as blending needs it.
  void draw_last();

 private:
  void add(vtkPolyData* data, const volume::Rgb& color, double opacity, bool has_colors);

  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;  ///< In the order of drawing.
  vtkSmartPointer<vtkPlane> cut_;
  bool is_visible_ = false;
};

}  // namespace trocar::scene::detail
