#pragma once

#include <vtkTextActor.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "motion/patient_motion.h"
#include "scene/camera.h"
#include "scene/detail/drawing.h"
#include "scene/scene_options.h"

namespace trocar::scene::detail {

/// Entry zone of the needle: the skin within a ball. Frame A, mm.
struct EntryMark {
  Vec3 centre_A = Vec3::Zero();
  double radius_mm = 0.0;
};

/// The expert's path, the entry zone on the skin and the target, and named landmarks.
class GuideLayer {
 public:
  explicit GuideLayer(vtkRenderer& renderer) : renderer_(renderer) {}

  /// Replaces path, zone and target, which are at rest and drawn where they are now: the path straight between its
  /// ends, the zone on the skin. `skin_distance_mm` is used to project the zone on the skin; may be empty.
  void set_path(const std::optional<Segment>& line_A, const EntryMark& entry, const volume::FloatGrid& skin_distance_mm,
                const motion::PatientMotion& motion);
  /// Moves the other paths and the landmarks.
  void set_motion(const motion::PatientMotion& motion);
  /// Further paths to compare with, faint; visible as the path is.
  void set_other_paths(std::span<const Segment> lines_A);
  void set_landmarks(const std::vector<anatomy::Landmark>& landmarks);
  // Return true if they changed something.
  bool set_guidance(Guidance guidance);
  bool set_guidance_visible(bool is_visible);
  bool set_landmarks_visible(bool is_visible);
  bool set_text_scale(double scale);
  /// Names of landmarks far behind the focal point of the view become faint.
  void look_from(const CameraView& view);
  Guidance guidance() const noexcept { return guidance_; }
  bool are_landmarks_visible() const noexcept { return are_landmarks_visible_; }

 private:
  /// Name of a landmark.
  struct Text {
    vtkSmartPointer<vtkTextActor> actor;
    Vec3 p_P;
  };
  using Props = std::vector<vtkSmartPointer<vtkProp>>;
  void add_mesh(Props& props, const TriangleMesh& mesh_P, const image::Rgb& color, double opacity, bool is_lit);
  void add_text(const Vec3& p_P, const std::string& text, const image::Rgb& color);
  void scale_texts();
  void clear(Props& props);
  void show_guidance();
  void draw_others();
  void draw_landmarks();

  vtkRenderer& renderer_;
  Props line_;    ///< The path from a point in front of the skin to the target.
  Props others_;  ///< Further paths.
  Props marks_;   ///< Target and entry zone.
  Props landmarks_;
  std::vector<Text> texts_;
  double text_scale_ = 1.0;
  std::vector<Segment> others_A_;
  std::vector<anatomy::Landmark> landmarks_A_;
  motion::PatientMotion motion_;
  Guidance guidance_ = Guidance::kPath;
  bool is_guidance_visible_ = true;
  bool are_landmarks_visible_ = false;
};

}  // namespace trocar::scene::detail
