#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "scene/detail/drawing.h"
#include "scene/scene_view.h"
#include "scene/tool_shapes.h"

namespace trocar::scene::detail {

/// One surface of all parts of a tool, each in its own colour.
vtkSmartPointer<vtkPolyData> to_colored_polydata(std::span<const ShapePart> parts);

/// An invisible actor that draws to_colored_polydata().
vtkSmartPointer<vtkActor> make_tool(vtkRenderer& renderer);
void set_data(vtkActor& tool, vtkPolyData* data);

/// Needle, ghost needle at the hand's pose, and transducer with its image.
class ToolLayer {
 public:
  explicit ToolLayer(vtkRenderer& renderer);

  // Each returns true if it changed something.
  bool set_needle(std::span<const Vec3> shaft_P, double diameter_mm, NeedleModel model);
  bool set_needle_goal(const std::optional<Segment>& ghost_P);
  bool set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P);
  bool set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P);
  bool set_scan(const std::optional<ScanView>& scan);
  /// Draws the transducer translucent.
  void set_transducer_translucent(bool is_translucent);
  /// Smallest diameter of the drawn needle.
  void set_least_thickness(double least_mm);

  /// Straight segment from hub to tip; empty without a needle.
  std::optional<Segment> needle_P() const noexcept;

 private:
  void rebuild_needle();
  bool set_transducer(const std::optional<Pose>& X_PT, const TransducerFace& face);
  bool set_picture(const ScanView& scan);

  std::vector<Vec3> shaft_P_;
  double diameter_mm_ = 1.0;
  NeedleModel model_ = NeedleModel::kChiba;
  double least_mm_ = 0.0;
  std::optional<Segment> ghost_P_, stylet_P_, core_P_, throw_P_, notch_P_;
  std::optional<Pose> X_PT_;
  std::optional<TransducerFace> face_;
  vtkSmartPointer<vtkActor> needle_;
  vtkSmartPointer<vtkActor> ghost_;
  vtkSmartPointer<vtkActor> shot_;
  vtkSmartPointer<vtkActor> throw_;
  vtkSmartPointer<vtkActor> transducer_;
  PictureQuad ultrasound_;
  std::uint64_t picture_number_ = 0;  ///< Of the shown image; 0: it has none.
};

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
