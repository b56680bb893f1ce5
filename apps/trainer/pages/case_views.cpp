#include "pages/case_views.h"

#include <QApplication>
#include <QGridLayout>
#include <algorithm>

#include "case_builder/ultrasound.h"
#include "slices/slice_geometry.h"
#include "views/patient/patient_view.h"
#include "views/slices/slice_marks.h"
#include "views/slices/slice_view.h"

namespace trocar::trainer {
namespace {

/// Gray levels as a patient without labels, for the slice viewer.
std::shared_ptr<const anatomy::VirtualPatient> as_patient(const volume::LabelGrid& gray_U) {
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->ct.geometry = gray_U.geometry;
  patient->ct.voxels.assign(gray_U.voxels.begin(), gray_U.voxels.end());
  return patient;
}

/// Lateral, beam and elevation at the middle of a volume, as columns.
Mat3 beam_frame(const case_builder::ImportedUltrasound& ultrasound) {
  const registration::Beams& beams = ultrasound.beams;
  const Vec3 middle_U = beams.is_fan() ? beams.to_point({0.0, 0.0, 0.5 * beams.depth_mm()}) : middle_of(ultrasound);
  registration::Beams::Place beside = beams.to_place(middle_U);
  beside.lateral += beams.is_fan() ? 0.01 : 1.0;  // rad, mm
  Mat3 R_UB;
  R_UB.col(1) = beams.direction(middle_U);
  const Vec3 lateral_U = beams.to_point(beside) - middle_U;
  R_UB.col(0) = (lateral_U - lateral_U.dot(R_UB.col(1)) * R_UB.col(1)).normalized();
  R_UB.col(2) = R_UB.col(0).cross(R_UB.col(1));
  return R_UB;
}

}  // namespace

CaseViews::CaseViews(case_builder::CaseEditor& editor, QWidget* parent) : QWidget(parent), editor_(editor) {
  grid_ = new QGridLayout(this);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setSpacing(4);
  add_slices();
  add_ultrasound_planes();
  add_3d();
  arrange();
}

void CaseViews::add_slices() {
  const SliceKind kinds[] = {SliceKind::kAxial, SliceKind::kCoronal, SliceKind::kSagittal};
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    auto* slice = new SliceView(kinds[n], this);
    slices_[n] = slice;
    marks_[n] = new SliceMarks(slice);
    connect(slice, &SliceView::focus_moved, this, [this, n](const Vec3& p_P) {
      for (std::size_t other = 0; other < slices_.size(); ++other)
        if (other != n) slices_[other]->set_focus(p_P);
      if (const auto pose = X_PU())
        for (SliceView* plane : planes_) plane->set_focus(pose->inverse() * p_P);
      // The wheel scrolls through slices without a change; a drag changes the draft.
      if (QApplication::mouseButtons().testFlag(Qt::LeftButton)) Q_EMIT placed(p_P, true);
    });
    connect(slice, &SliceView::clicked, this, [this](const Vec3& p_P) { Q_EMIT placed(p_P, false); });
  }
}

void CaseViews::add_ultrasound_planes() {
  const SliceKind kinds[] = {SliceKind::kLateral, SliceKind::kElevation, SliceKind::kAcrossBeams};
  for (std::size_t n = 0; n < planes_.size(); ++n) {
    auto* plane = new SliceView(kinds[n], this);
    planes_[n] = plane;
    plane_marks_[n] = new SliceMarks(plane);
    connect(plane, &SliceView::focus_moved, this, [this, n](const Vec3& p_U) {
      for (std::size_t other = 0; other < planes_.size(); ++other)
        if (other != n) planes_[other]->set_focus(p_U);
      if (const auto pose = X_PU())
        for (SliceView* slice : slices_) slice->set_focus(*pose * p_U);
      if (QApplication::mouseButtons().testFlag(Qt::LeftButton)) Q_EMIT placed_in_ultrasound(p_U, true);
    });
    connect(plane, &SliceView::clicked, this, [this](const Vec3& p_U) { Q_EMIT placed_in_ultrasound(p_U, false); });
  }
}

void CaseViews::add_3d() {
  view_ = new PatientView(this);
  view_->setObjectName(QStringLiteral("case-3d"));
  view_->set_landmarks_visible(true);
  connect(view_, &PatientView::picked, this, [this](const Vec3& p_P) {
    show_place(p_P);
    Q_EMIT placed(p_P, false);
  });
}

void CaseViews::arrange() {
  while (QLayoutItem* item = grid_->takeAt(0)) delete item;
  view_->setVisible(!is_ultrasound_shown_);
  for (SliceView* plane : planes_) plane->setVisible(is_ultrasound_shown_);
  if (is_ultrasound_shown_) {
    for (int n = 0; n < 3; ++n) {
      grid_->addWidget(slices_[static_cast<std::size_t>(n)], 0, n);
      grid_->addWidget(planes_[static_cast<std::size_t>(n)], 1, n);
    }
  } else {
    grid_->addWidget(slices_[0], 0, 0);
    grid_->addWidget(view_, 0, 1);
    grid_->addWidget(slices_[1], 1, 0);
    grid_->addWidget(slices_[2], 1, 1);
  }
  for (int row = 0; row < 2; ++row) grid_->setRowStretch(row, 1);
  for (int column = 0; column < 3; ++column)
    grid_->setColumnStretch(column, column < 2 || is_ultrasound_shown_ ? 1 : 0);
}

void CaseViews::set_ultrasound_shown(bool is_shown) {
  if (std::exchange(is_ultrasound_shown_, is_shown) == is_shown) return;
  for (SliceView* slice : slices_) slice->set_label_opacity(is_shown ? 0.0 : label_opacity_);  // only outlines
  arrange();
  refresh_fusion();
}

void CaseViews::set_fusion(const slices::FusionStyle& style) {
  fusion_ = style;
  refresh_fusion();
}

std::optional<Pose> CaseViews::X_PU() const {
  const case_builder::CaseDraft& draft = editor_.draft();
  return draft.ultrasound && draft.placement ? std::optional(draft.placement->X_PU) : std::nullopt;
}

void CaseViews::show_place(const Vec3& p_P) {
  for (SliceView* slice : slices_) slice->set_focus(p_P);
  if (const auto pose = X_PU())
    for (SliceView* plane : planes_) plane->set_focus(pose->inverse() * p_P);
}

void CaseViews::show_ultrasound_place(const Vec3& p_U) {
  for (SliceView* plane : planes_) plane->set_focus(p_U);
}

void CaseViews::set_label_opacity(double opacity) {
  label_opacity_ = opacity;
  if (is_ultrasound_shown_) return;
  for (SliceView* slice : slices_) slice->set_label_opacity(opacity);
}

void CaseViews::set_label_visible(const std::string& name, bool is_visible) {
  view_->set_opacity(name, is_visible ? 1.0 : 0.0);
}

void CaseViews::draw() {
  if (!is_ultrasound_shown_) view_->draw();
}

void CaseViews::refresh_patient() {
  if (editor_.patient() == shown_patient_ && editor_.meshes() == shown_meshes_) return;
  shown_patient_ = editor_.patient();
  shown_meshes_ = editor_.meshes();
  for (SliceView* slice : slices_) slice->show_patient(shown_patient_);
  const bool is_known = placed_import_ == editor_.draft().imported && view_->is_ready();
  const scene::CameraView before = view_->view();
  if (shown_patient_ && shown_meshes_) view_->show_patient(shown_patient_, shown_meshes_);
  if (is_known) view_->set_view(before);  // a new name or tissue does not change the camera
  shown_landmarks_.reset();
}

void CaseViews::refresh(bool follows_path) {
  refresh_patient();
  const case_builder::CaseDraft& draft = editor_.draft();
  const auto target_P = case_builder::find_target_point(draft);
  if (placed_import_ != draft.imported && shown_patient_) {
    placed_import_ = draft.imported;
    for (SliceView* slice : slices_) slice->reset();
    if (target_P) show_place(*target_P);
  }
  const anatomy::NeedlePath* path = case_builder::find_expert_path(draft);
  const std::optional<Segment> line_P = path != nullptr ? std::optional(path->line_P) : std::nullopt;
  if (line_P && !shown_path_ && follows_path) show_place(line_P->b);
  shown_path_ = line_P;
  const std::optional<tasks::EntryZone>& zone = draft.task.entry_zone;
  view_->set_path(line_P, zone ? zone->radius_mm : 0.0);
  view_->scene().set_entry_centre(zone ? std::optional(zone->centre_P) : std::nullopt);
  refresh_landmarks();
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    slices_[n]->set_paths(line_P, {});
    slices_[n]->set_entry_zone(draft.task.entry_zone);
    marks_[n]->set_target(target_P);
  }
  refresh_ultrasound();
  refresh_fusion();
}

void CaseViews::refresh_ultrasound() {
  const case_builder::CaseDraft& draft = editor_.draft();
  if (shown_ultrasound_ != draft.ultrasound) {
    shown_ultrasound_ = draft.ultrasound;
    const auto patient = shown_ultrasound_ ? as_patient(shown_ultrasound_->gray_U) : nullptr;
    for (SliceView* plane : planes_) {
      if (shown_ultrasound_) plane->set_beam_frame(beam_frame(*shown_ultrasound_));
      const slices::Box box_U = patient ? slices::volume_box(patient->ct.geometry) : slices::Box();
      plane->show_patient(patient, box_U);
      if (!shown_ultrasound_) continue;
      plane->set_window(0.5 * shown_ultrasound_->white, shown_ultrasound_->white);
      plane->set_focus(middle_of(*shown_ultrasound_));
    }
  }
  std::vector<anatomy::Landmark> landmarks;
  for (const registration::NamedPoint& point : draft.ultrasound_landmarks) landmarks.push_back({point.name, point.p});
  for (SliceMarks* marks : plane_marks_) marks->set_landmarks(landmarks);
}

void CaseViews::refresh_fusion() {
  const auto pose = X_PU();
  SliceView::Overlay overlay;
  if (is_ultrasound_shown_ && pose && fusion_.kind != slices::FusionKind::kOff)
    overlay = [ultrasound = editor_.draft().ultrasound, pose = *pose, style = fusion_](const volume::SlicePlane& plane,
                                                                                       image::RgbImage& picture) {
      slices::fuse_ultrasound({ultrasound->gray_U, ultrasound->imaged_U, ultrasound->white, pose}, plane, style,
                              picture);
    };
  for (SliceView* slice : slices_) slice->set_overlay(overlay);
  // A new pose: both volumes at the point of the ultrasound's cross-hairs.
  const bool is_new = pose && (!shown_pose_ || shown_pose_->p() != pose->p() || shown_pose_->R() != pose->R());
  if (is_new && is_ultrasound_shown_) show_place(*pose * planes_[0]->focus());
  if (is_ultrasound_shown_) shown_pose_ = pose;
}

void CaseViews::refresh_landmarks() {
  const std::vector<anatomy::Landmark>& landmarks = editor_.draft().landmarks;
  const auto is_same = [](const anatomy::Landmark& a, const anatomy::Landmark& b) {
    return a.name == b.name && a.p_P == b.p_P;
  };
  if (shown_landmarks_ &&
      std::equal(landmarks.begin(), landmarks.end(), shown_landmarks_->begin(), shown_landmarks_->end(), is_same))
    return;
  shown_landmarks_ = landmarks;
  view_->scene().set_landmarks(landmarks);
  for (SliceMarks* marks : marks_) marks->set_landmarks(landmarks);
}

}  // namespace trocar::trainer
