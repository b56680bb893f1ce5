#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/detail/drawing.h"
#include "scene/fingertip.h"

namespace trocar::scene::detail {

/// A palpating fingertip, and dots of a skin marker.
class HandLayer {
 public:
  explicit HandLayer(vtkRenderer& renderer);

  /// True if it changed something.
  bool set(const std::optional<Fingertip>& finger, std::span<const Vec3> skin_marks_P);

 private:
  bool set_finger(const std::optional<Fingertip>& finger);
  bool set_marks(std::span<const Vec3> marks_P);

  std::optional<Fingertip> finger_;
  std::vector<Vec3> marks_P_;
  vtkSmartPointer<vtkActor> finger_actor_, marks_actor_;
};

}  // namespace trocar::scene::detail
