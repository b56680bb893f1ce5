#pragma once

#include <QWidget>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "case_builder/case_editor.h"
#include "slices/paint_slice.h"

class QGridLayout;

namespace trocar::trainer {

class PatientView;
class SliceMarks;
class SliceView;

/// Images of the case builder: three slices of the CT and a 3D view, or, for the recorded ultrasound, the slices above
/// three planes of its volume. With a pose, the ultrasound is drawn in the slices of the CT (FusionStyle) and the
/// cross-hairs of both volumes move together. Shows the editor's draft.
class CaseViews : public QWidget {
  Q_OBJECT

 public:
  explicit CaseViews(case_builder::CaseEditor& editor, QWidget* parent = nullptr);

  /// Call when the editor has changed. `follows_path`: a new path moves the slices to its end.
  void refresh(bool follows_path);
  /// Draws the 3D view; once per frame.
  void draw();
  void set_ultrasound_shown(bool is_shown);
  void set_fusion(const slices::FusionStyle& style);
  /// Moves all slices to a point of P, or of U.
  void show_place(const Vec3& p_P);
  void show_ultrasound_place(const Vec3& p_U);
  void set_label_opacity(double opacity);
  void set_label_visible(const std::string& name, bool is_visible);

 Q_SIGNALS:
  /// A click (or a drag with the left button) in an image of the CT, and in one of the ultrasound.
  void placed(const trocar::Vec3& p_P, bool is_drag);
  void placed_in_ultrasound(const trocar::Vec3& p_U, bool is_drag);

 private:
  void add_slices();
  void add_ultrasound_planes();
  void add_3d();
  void arrange();
  void refresh_patient();
  void refresh_ultrasound();
  void refresh_landmarks();
  void refresh_fusion();
  std::optional<Pose> X_PU() const;

  case_builder::CaseEditor& editor_;
  QGridLayout* grid_ = nullptr;
  std::array<SliceView*, 3> slices_{}, planes_{};
  std::array<SliceMarks*, 3> marks_{}, plane_marks_{};
  PatientView* view_ = nullptr;
  bool is_ultrasound_shown_ = false;
  double label_opacity_ = slices::SliceStyle{}.label_opacity;
  slices::FusionStyle fusion_;

  // What is displayed; initially nothing.
  std::shared_ptr<const anatomy::VirtualPatient> shown_patient_;
  std::shared_ptr<const std::vector<anatomy::NamedMesh>> shown_meshes_;
  std::shared_ptr<const case_builder::ImportedPatient> placed_import_;
  std::shared_ptr<const case_builder::ImportedUltrasound> shown_ultrasound_;
  std::optional<Pose> shown_pose_;
  std::optional<Segment> shown_path_;
  std::optional<std::vector<anatomy::Landmark>> shown_landmarks_;
};

}  // namespace trocar::trainer
