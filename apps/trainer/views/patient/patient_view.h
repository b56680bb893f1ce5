#pragma once

#include <QImage>
#include <QWidget>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scene/detail_policy.h"
#include "scene/patient_scene.h"

namespace trocar::trainer {

/// The patient in 3D with tools and guidance (scene().show()). Setters are cheap and may be called every frame;
/// `draw()` renders if something has changed or the image quality must increase. The view is drawn off-screen and
/// painted as an image: with an OpenGL widget, Qt composes the whole window by OpenGL, which costs more processor time
/// than drawing the patient.
///
/// Mouse: left drag rotates, middle drag or Shift + left drag pans, right drag or wheel zooms, double click picks.
/// Keys: 1..6 views (anterior, oblique, right, left, posterior, cranial), T follow the needle's tip, L view along the
/// needle, B view beside the needle, Home resets, arrows rotate, + and - zoom, O guidance, I landmarks.
class PatientView : public QWidget {
  Q_OBJECT

 public:
  explicit PatientView(QWidget* parent = nullptr);
  ~PatientView() override;

  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient,
                    std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
                    const std::optional<Vec3>& target_P = {});
  /// More surfaces of the same patient, with new names.
  void add_surfaces(std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes);
  /// A line at the bottom of the view while surfaces are missing; empty: none.
  void set_note(const QString& note);
  /// Surfaces are prepared in the background after show_patient.
  bool is_ready() const;

  void set_path(const std::optional<Segment>& line_P, double entry_radius_mm);
  void set_other_paths(std::span<const Segment> lines_P);
  /// Sets the amount of guidance; set_guidance_visible and the key O show and hide it.
  void set_guidance(scene::Guidance guidance);
  void set_guidance_visible(bool is_visible);
  bool is_guidance_visible() const noexcept { return is_guidance_visible_; }
  void set_landmarks_visible(bool are_visible);
  bool are_landmarks_visible() const noexcept { return are_landmarks_visible_; }

  std::vector<scene::StructureInfo> structures() const;
  void set_opacity(std::string_view name, double opacity);
  void apply_preset(scene::StructurePreset preset);
  void set_volume_preset(scene::VolumePreset preset);
  scene::VolumePreset volume_preset() const;
  void set_mpr(const scene::MprOptions& options);
  scene::MprOptions mpr() const;

  void set_camera(scene::CameraPreset preset);
  void set_view(const scene::CameraView& view);
  const scene::CameraView& view() const;
  /// Eye and unit direction of the line of sight at a place of the widget, and the place of a point in front of it.
  std::pair<Vec3, Vec3> ray_at(const QPointF& place) const;
  QPointF position_of(const Vec3& p_P) const;
  void set_follow(scene::FollowMode mode);
  scene::FollowMode follow() const;
  /// Turns the side with this outward direction of the skin to the viewer; reset_camera() returns to it.
  void face(const Vec3& outward_P);
  void reset_camera();

  void set_stereo(const scene::StereoOptions& options);
  const scene::StereoOptions& stereo() const;
  /// Sets the function that maps a global row to its screen row, for interlaced stereo in a mirrored window. Without
  /// it, both rows are equal.
  void set_row_on_screen(std::function<int(int)> row_on_screen);
  /// True if the screen supports quad-buffer stereo.
  static bool has_quad_buffer();

  /// Tools move without user input (haptic device, replay): keeps the image at low detail.
  void set_tools_moving(bool are_moving);
  /// Target frame time during motion without a graphics card, ms, 5..500.
  void set_frame_target(double target_ms);
  /// Polled while a full-quality image is rendered, which is slow without a graphics card: true cancels it. Pointer and
  /// keys are always checked. Called in the GUI thread.
  void set_interrupt(std::function<bool()> wants_break);
  void draw();
  /// Draws at once in full quality, without interruption (screenshots).
  void draw_whole();

  /// Times of frames during motion; still_frame_times() are those in full quality.
  const scene::FrameTimes& moving_frame_times() const noexcept;
  const scene::FrameTimes& still_frame_times() const noexcept;
  /// Intervals without a check for input while a full-quality image is rendered: the latency of its cancellation.
  const scene::FrameTimes& unwatched_times() const noexcept;
  void clear_frame_times() noexcept;
  /// True if the last frame was drawn in full quality.
  bool is_still() const noexcept;
  int broken_frames() const noexcept;
  scene::PatientScene& scene() noexcept;

  QSize sizeHint() const override { return {760, 560}; }
  QSize minimumSizeHint() const override { return {240, 180}; }

 Q_SIGNALS:
  /// Double click on a surface, with the point in P (mm).
  void picked(const trocar::Vec3& p_P);
  /// The user has changed a setting of a panel with mouse or keys: opacity, camera, guidance.
  void changed();

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  struct Impl;
  void note_motion();
  void render(const scene::Detail& detail, bool may_break);
  /// Size in screen pixels.
  QSize picture_size(const scene::Detail& detail) const;
  bool render_eye(const scene::Detail& detail, bool may_break, scene::Eye eye, QImage& image);
  /// Event position in the unmirrored image.
  QPointF unmirrored(const QPointF& place) const;

  std::unique_ptr<Impl> impl_;
  scene::CameraPreset home_ = scene::CameraPreset::kRightAnteriorOblique;
  bool is_guidance_visible_ = true;
  bool are_landmarks_visible_ = false;
  Qt::MouseButton drag_ = Qt::NoButton;
  QPointF last_place_;  ///< Pointer position during a drag, unmirrored.
};

}  // namespace trocar::trainer
