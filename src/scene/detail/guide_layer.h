#pragma once

#include <vtkBillboardTextActor3D.h>

#include <optional>
#include <vector>

#include "scene/detail/drawing.h"

namespace trocar::detail {

/// The expert's path with its entry zone on the skin and its target, and named landmarks.
class GuideLayer {
 public:
  explicit GuideLayer(vtkRenderer& renderer) : renderer_(renderer) {}

  /// Draws the path anew. `skin_distance_mm` lays the entry zone on the skin; may be empty.
  void set_path(const std::optional<Segment>& line_P, double entry_radius_mm, const FloatGrid& skin_distance_mm);
  void set_landmarks(const std::vector<Landmark>& landmarks);
  /// True when it changed something.
  bool set_path_visible(bool is_visible);
  bool set_landmarks_visible(bool is_visible);
  bool is_path_visible() const noexcept { return is_path_visible_; }
  bool are_landmarks_visible() const noexcept { return are_landmarks_visible_; }

 private:
  using Props = std::vector<vtkSmartPointer<vtkProp>>;
  void add_mesh(Props& props, const TriangleMesh& mesh_P, const Rgb& color, double opacity, bool is_lit);
  void add_text(Props& props, const Vec3& p_P, const std::string& text, const Rgb& color);
  void clear(Props& props);

  vtkRenderer& renderer_;
  Props path_;
  Props landmarks_;
  bool is_path_visible_ = true;
  bool are_landmarks_visible_ = false;
};

}  // namespace trocar::detail
