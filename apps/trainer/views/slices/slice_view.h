#pragma once

#include <QWidget>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "motion/patient_motion.h"
#include "scene/scene_options.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"
#include "tasks/task.h"
#include "ui_kit/action_table.h"

namespace trocar::trainer {

struct SliceCanvas;

/// Three radiological slices through the focus, three planes of the needle through its tip (NeedlePlane), and three
/// planes of an ultrasound volume: along the beams, along the beams and the elevation, across the beams (C-plane).
enum class SliceKind {
  kAxial,
  kCoronal,
  kSagittal,
  kAlongNeedle,
  kAlongNeedleTurned,
  kAcrossNeedle,
  kLateral,
  kElevation,
  kAcrossBeams
};

class ViewStrip;

/// One slice viewer: CT with labels in a plane, under a strip with name, position and window; cross-hairs in the
/// colours of the planes they represent, orientation letters, a scale bar, the needle, and the plan as far as the
/// guidance shows it. Points are in P (LPS, mm). Object names: slice-axial, slice-coronal, slice-sagittal,
/// slice-along-needle, slice-along-turned, slice-across-needle, us-lateral, us-elevation, us-across-beams.
///
/// A view of an ultrasound volume shows gray levels as "HU", in the frame U of the volume instead of P, without
/// orientation letters and labels.
///
/// Mouse: left drag moves the cross-hairs; right drag changes the window (right: wider, up: brighter); middle drag or
/// Shift + left drag pans; wheel scrolls through slices, Ctrl + wheel zooms at the pointer; double click centres the
/// point.
/// Keys: + - zoom, arrows move the cross-hairs by 1 mm (Shift: 10 mm; they pan a needle's plane), Page Up/Down scroll,
/// R resets, L toggles labels, 1..5 window presets.
class SliceView : public QWidget {
  Q_OBJECT

 public:
  explicit SliceView(SliceKind kind, QWidget* parent = nullptr);
  ~SliceView() override;

  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient);
  /// The same with the known body_box() of the patient.
  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient, const slices::Box& body_P);
  /// Directions in U of an ultrasound volume: lateral, beam, elevation (columns); for the planes of an ultrasound.
  void set_beam_frame(const Mat3& R_UB);
  /// Draws over the image of the CT, below lines and marks; for example a fused volume. Empty: nothing.
  using Overlay = std::function<void(const volume::SlicePlane&, image::RgbImage&)>;
  void set_overlay(Overlay overlay);
  /// Moves the slice to a point; pans if the point leaves the central part of the image.
  void set_focus(const Vec3& p_P);
  /// Where the patient is; its model belongs to the patient.
  void set_motion(const motion::PatientMotion& motion);
  const motion::PatientMotion& motion() const noexcept { return motion_; }
  /// From hub to tip; empty hides the needle.
  void set_needle(std::span<const Vec3> shaft_P);
  /// Pose with which needle planes are aligned.
  void set_needle_frame(const Pose& X_PN);
  /// Sets whether that frame is the one of the tip or of the needle at the skin; shown in the strip.
  void set_frame_at_skin(bool is_at_skin);
  /// The expert path, from the skin to the target, and others to compare with, faint.
  void set_paths(const std::optional<Segment>& path_P, std::vector<Segment> others_P);
  void set_entry_zone(const std::optional<tasks::EntryZone>& zone);
  /// Amount of guidance shown: path, target and zone; with the path also the needle's direction. With none, lesions are
  /// painted as the organ around them.
  void set_guidance(scene::Guidance guidance);
  /// Does not emit window_changed. Width: at least 1 HU.
  void set_window(double centre_hu, double width_hu);
  /// Opacity of the labels' fill, 0..1.
  void set_label_opacity(double opacity);
  void set_labels_visible(bool is_visible);
  /// Shows the whole body, or the surroundings of the tip, in the default window.
  void reset();

  SliceKind kind() const noexcept { return kind_; }
  const Vec3& focus() const noexcept { return focus_P_; }
  const slices::Window& window() const noexcept { return style_.window; }
  bool has_labels() const noexcept { return has_labels_; }
  /// Geometry of the image in device pixels.
  const slices::SliceGeometry& geometry() const noexcept { return geometry_; }
  /// Rectangle of the image in the widget, in points.
  QRectF picture_rect() const;
  /// Name, position and window; a dock may show it in its title.
  ViewStrip& strip() noexcept { return *strip_; }
  /// The point of the slice at a point of the widget; position_of() is the inverse.
  Vec3 point_at(const QPointF& position) const;
  QPointF position_of(const Vec3& p_P) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  /// The user has moved the cross-hairs or scrolled.
  void focus_moved(const trocar::Vec3& p_P);
  void window_changed(double centre_hu, double width_hu);
  /// A click without a drag.
  void clicked(const trocar::Vec3& p_P);

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool has_use_for(const FoundAction& found) const;
  void changeEvent(QEvent* event) override;

 private:
  enum class Drag { kNone, kFocus, kWindow, kPan };

  bool is_ultrasound() const noexcept { return kind_ >= SliceKind::kLateral; }
  bool follows_needle() const noexcept { return kind_ >= SliceKind::kAlongNeedle && !is_ultrasound(); }
  slices::Window first_window() const;
  /// Point of the plane and of the cross-hairs.
  Vec3 anchor_P() const;
  void update_axes();
  /// Moves the plane to the anchor along its normal; the in-plane position of the image is kept.
  void move_plane_to_anchor();
  /// Pans just enough that the anchor is in the central part of the image.
  void follow_anchor();
  void update_size();
  void fit();
  void move_focus(const Vec3& p_P);
  void pan_by(const QPointF& points);
  void zoom_at(const QPointF& position, double factor);
  void scroll(double slices);
  double slice_step_mm() const;
  void change_window(const slices::Window& window);
  Eigen::Vector2d to_pixel(const QPointF& position) const;
  void redraw_picture();
  void paint_strip(QPainter& painter, QRectF room) const;
  QString window_text() const;
  void paint_overlay(QPainter& painter) const;
  void draw_plan(const SliceCanvas& canvas) const;
  QString place_text() const;

  SliceKind kind_;
  ViewStrip* strip_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  slices::Box body_P_;
  Vec3 focus_P_ = Vec3::Zero();
  Pose X_PN_;
  Mat3 R_UB_ = Mat3::Identity();
  Overlay overlay_;
  bool is_frame_at_skin_ = false;
  double offset_mm_ = 0.0;  ///< Offset of a needle plane from the tip, along the plane's normal.
  std::vector<Vec3> shaft_P_;
  std::optional<Segment> path_A_;
  std::vector<Segment> other_paths_P_;
  std::optional<tasks::EntryZone> zone_;
  scene::Guidance guidance_ = scene::Guidance::kPath;
  bool has_labels_ = true;
  bool is_fitted_ = true;  ///< True until the user pans or zooms: a new size fits the image again.

  slices::SliceGeometry geometry_;
  double device_pixel_ratio_ = 1.0;
  slices::SliceStyle style_;
  motion::PatientMotion motion_;
  slices::SliceBuffers buffers_;
  image::RgbImage picture_;
  bool is_stale_ = true;  ///< The image must be painted again before it is shown.

  Drag drag_ = Drag::kNone;
  QPointF pressed_at_, dragged_to_;
  bool is_click_ = false;
};

}  // namespace trocar::trainer
