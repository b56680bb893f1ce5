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

#include "scene/frame_times.h"
#include "scene/patient_scene.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::trainer {

/// The patient in 3D with tools and guidance. Setters are cheap and may be called every frame; `draw()` renders when
/// something has changed or the picture's quality is to rise. Drawn off-screen and painted as an image: a widget that
/// OpenGL draws on makes Qt put the whole window together by OpenGL, which costs a processor more than the patient.
///
/// Mouse: left drag turns, middle drag or Shift + left drag moves, right drag or wheel zooms, double click picks.
/// Keys: 1..6 views (anterior, oblique, right, left, posterior, cranial), T follow the needle's tip, L look along the
/// needle, B beside the needle, Home resets, arrows turn, + and - zoom, O guidance, I landmarks.
class PatientView : public QWidget {
  Q_OBJECT

 public:
  explicit PatientView(QWidget* parent = nullptr);
  ~PatientView() override;

  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient,
                    std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
                    const std::optional<Vec3>& target_P = {});
  /// Surfaces are prepared in the background after show_patient.
  bool is_ready() const;

  void set_path(const std::optional<Segment>& line_P, double entry_radius_mm);
  /// What the guidance consists of; set_guidance_visible and the key O show and hide that.
  void set_guidance(scene::Guidance guidance);
  void set_guidance_visible(bool is_visible);
  bool is_guidance_visible() const noexcept { return is_guidance_visible_; }
  void set_landmarks_visible(bool are_visible);
  bool are_landmarks_visible() const noexcept { return are_landmarks_visible_; }

  /// From the hub to the tip; fewer than two points: no needle.
  void set_needle(std::span<const Vec3> shaft_P, double diameter_mm, scene::NeedleModel model);
  /// Where the hand holds the needle, hub to tip; nothing when it is where the needle is.
  void set_needle_goal(const std::optional<Segment>& ghost_P);
  void set_shot(const std::optional<Segment>& stylet_P, const std::optional<Segment>& core_P);
  void set_transducer(const std::optional<Pose>& X_PT, const ultrasound::ScanGeometry& scan);
  /// Corners of the picture's outline in P: top left, top right, bottom left. What lies outside of the scan of the last
  /// set_transducer is transparent; without a transducer nothing is. An empty picture hides it.
  void set_ultrasound(const volume::RgbImage& picture, const std::array<Vec3, 3>& corners_P);
  void hide_ultrasound();

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
  void set_follow(scene::FollowMode mode);
  scene::FollowMode follow() const;
  /// The view that the last patient began with.
  void reset_camera();

  void set_stereo(const scene::StereoOptions& options);
  const scene::StereoOptions& stereo() const;
  /// Which row of the screen a global row is drawn at; for pictures of interlaced rows in a window that is turned over.
  /// Without it: the same.
  void set_row_on_screen(std::function<int(int)> row_on_screen);
  /// Whether the screen can show quad-buffer stereo.
  static bool has_quad_buffer();

  /// Tools move without user input (haptic device, replay): keeps the image at low detail.
  void set_tools_moving(bool are_moving);
  /// What a frame may take while things move, ms, 5..500, without a graphics card.
  void set_frame_target(double target_ms);
  /// Polled while a full-quality image is rendered, which is slow without a graphics card: true cancels it. Pointer and
  /// keys are always checked. Called in the GUI thread.
  void set_interrupt(std::function<bool()> wants_break);
  void draw();
  /// Draws now in full quality, without a break (screenshots).
  void draw_whole();

  /// Of the frames while things moved, and of those in full quality.
  const scene::FrameTimes& moving_frame_times() const noexcept;
  const scene::FrameTimes& still_frame_times() const noexcept;
  /// Times for which a picture of full quality did not look for input: it is given up so long after the hand moves.
  const scene::FrameTimes& unwatched_times() const noexcept;
  void clear_frame_times() noexcept;
  /// The last frame was drawn in full quality.
  bool is_still() const noexcept;
  int broken_frames() const noexcept;
  scene::PatientScene& scene() noexcept;

  QSize sizeHint() const override { return {760, 560}; }
  QSize minimumSizeHint() const override { return {240, 180}; }

 Q_SIGNALS:
  /// Double click on a surface, with the point in P (mm).
  void picked(const trocar::Vec3& p_P);
  /// The user has changed something with mouse or keys that a panel shows: opacity, camera, guidance.
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
  /// In pixels of the screen.
  QSize picture_size(const scene::Detail& detail) const;
  bool render_eye(const scene::Detail& detail, bool may_break, scene::Eye eye, QImage& image);
  /// Places of events as the unmirrored picture has them.
  QPointF unmirrored(const QPointF& place) const;

  std::unique_ptr<Impl> impl_;
  bool is_guidance_visible_ = true;
  bool are_landmarks_visible_ = false;
  Qt::MouseButton drag_ = Qt::NoButton;
  QPointF last_place_;  ///< Of the pointer in a drag, unmirrored.
};

}  // namespace trocar::trainer
