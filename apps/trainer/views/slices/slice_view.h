#pragma once

#include <QWidget>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "geometry/segment.h"
#include "scene/guidance.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"
#include "tasks/task.h"

namespace trocar::trainer {

struct SliceCanvas;

/// Three radiological slices through the focus, and three planes of the needle through its tip (NeedlePlane).
enum class SliceKind { kAxial, kCoronal, kSagittal, kAlongNeedle, kAlongNeedleTurned, kAcrossNeedle };

class ViewStrip;

/// One slice viewer: CT with labels in a plane, under a strip with name, place and window; cross-hairs in the colours
/// of the planes they stand for, orientation letters, a scale bar, the needle, and as much of the plan as is to be
/// seen. Points are in P (LPS, mm). Object names: slice-axial, slice-coronal, slice-sagittal, slice-along-needle,
/// slice-along-turned, slice-across-needle.
///
/// Mouse: left drag moves the cross-hairs; right drag changes the window (right: wider, up: brighter); middle drag or
/// Shift + left drag pans; wheel scrolls through slices, Ctrl + wheel zooms at the pointer; double click puts the
/// point in the middle.
/// Keys: + - zoom, arrows move the cross-hairs by 1 mm (Shift: 10 mm; they pan a needle's plane), Page Up/Down scroll,
/// R reset, L labels on and off, 1..5 window presets.
class SliceView : public QWidget {
  Q_OBJECT

 public:
  explicit SliceView(SliceKind kind, QWidget* parent = nullptr);
  ~SliceView() override;

  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient);
  /// The same where the patient's body_box() is known.
  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient, const slices::Box& body_P);
  /// Moves the slice to a point and, where that leaves the middle part of the picture, the picture after it.
  void set_focus(const Vec3& p_P);
  /// From hub to tip; empty hides the needle.
  void set_needle(std::span<const Vec3> shaft_P);
  /// The pose that a needle's planes are aligned with.
  void set_needle_frame(const Pose& X_PN);
  /// Whether that frame is the tip's, or that of the needle at the skin; said in the strip.
  void set_frame_at_skin(bool is_at_skin);
  /// The expert path, from the skin to the target.
  void set_path(const std::optional<Segment>& path_P);
  void set_entry_zone(const std::optional<tasks::EntryZone>& zone);
  /// What is shown of path, target and zone; with the path also where the needle would go.
  /// With none, lesions are painted as the organ around them.
  void set_guidance(scene::Guidance guidance);
  /// Does not signal window_changed. Width: at least 1 HU.
  void set_window(double centre_hu, double width_hu);
  /// Of the labels' fill, 0..1.
  void set_label_opacity(double opacity);
  void set_labels_visible(bool is_visible);
  /// The whole body, or what is around the tip, in the default window.
  void reset();

  SliceKind kind() const noexcept { return kind_; }
  const Vec3& focus() const noexcept { return focus_P_; }
  const slices::Window& window() const noexcept { return style_.window; }
  bool has_labels() const noexcept { return has_labels_; }
  /// Of the picture in device pixels.
  const slices::SliceGeometry& geometry() const noexcept { return geometry_; }
  /// Where the picture lies in the widget, in points.
  QRectF picture_rect() const;
  /// Name, place and window; a dock may take it into its title.
  ViewStrip& strip() noexcept { return *strip_; }
  /// The point of the slice behind a point of the widget, and back.
  Vec3 point_at(const QPointF& position) const;
  QPointF position_of(const Vec3& p_P) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  /// A person has moved the cross-hairs or scrolled.
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
  void changeEvent(QEvent* event) override;

 private:
  enum class Drag { kNone, kFocus, kWindow, kPan };

  bool follows_needle() const noexcept { return kind_ >= SliceKind::kAlongNeedle; }
  /// The point that the plane goes through and the cross-hairs stand on.
  Vec3 anchor_P() const;
  void update_axes();
  /// Puts the plane through the anchor, keeping the picture's place in it.
  void move_plane_to_anchor();
  /// Moves the picture just so far that the anchor comes back into its middle part.
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
  bool is_frame_at_skin_ = false;
  double offset_mm_ = 0.0;  ///< Of a needle's plane from the tip, along the plane's normal.
  std::vector<Vec3> shaft_P_;
  std::optional<Segment> path_P_;
  std::optional<tasks::EntryZone> zone_;
  scene::Guidance guidance_ = scene::Guidance::kPath;
  bool has_labels_ = true;
  bool is_fitted_ = true;  ///< Until someone pans or zooms: a new size fits the picture again.

  slices::SliceGeometry geometry_;
  double device_pixel_ratio_ = 1.0;
  slices::SliceStyle style_;
  slices::SliceBuffers buffers_;
  volume::RgbImage picture_;
  bool is_stale_ = true;  ///< The picture must be painted anew before it is shown.

  Drag drag_ = Drag::kNone;
  QPointF pressed_at_, dragged_to_;
  bool is_click_ = false;
};

}  // namespace trocar::trainer
