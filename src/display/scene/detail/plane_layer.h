#pragma once

#include <array>
#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "motion/patient_motion.h"
#include "scene/detail/drawing.h"
#include "scene/scene_options.h"

namespace trocar::scene::detail {

/// CT planes along the needle.
class PlaneLayer {
 public:
  explicit PlaneLayer(vtkRenderer& renderer);

  /// Stores a reference to CT and skin distance (may be empty) of the patient, without a copy; nullptr: no patient.
  void set_patient(const anatomy::VirtualPatient* patient) noexcept;
  bool set_options(const MprOptions& options);
  void set_motion(const motion::PatientMotion& motion);
  const MprOptions& options() const noexcept { return options_; }
  /// Samples the planes again if the needle or the options have changed; `pixels` along an edge.
  void update(const std::optional<Segment>& needle_P, int pixels);

 private:
  void draw(PictureQuad& quad, const Vec3& middle_P, const Vec3& right_P, const Vec3& down_P, int pixels);

  const anatomy::VirtualPatient* patient_ = nullptr;
  MprOptions options_;
  std::array<PictureQuad, 3> quads_;
  motion::PatientMotion motion_;
  std::vector<float> hu_;
  std::vector<Vec3f> rest_A_;
  std::optional<Segment> drawn_for_P_;
  int drawn_pixels_ = 0;
};

}  // namespace trocar::scene::detail
