#pragma once

#include <QImage>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "motion/patient_motion.h"
#include "ultrasound/doppler/flow_on_demand.h"
#include "ultrasound/live/live_scanner.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/probe/transducer.h"
#include "ultrasound/scanner/measurements.h"
#include "views/ultrasound/caliper_marks.h"
#include "views/ultrasound/ultrasound_box.h"
#include "views/ultrasound/ultrasound_layout.h"
#include "views/ultrasound/ultrasound_settings.h"

namespace trocar::trainer {

enum class MeasuringTool { kNone, kDistance, kEllipse, kAngle };

/// Screen of an ultrasound scanner: the image with depth scale, focus, orientation marker, gray wedge, colour bar and
/// captions, calipers and needle guide. A separate thread computes the images; no function blocks.
///
/// Keys, in the whole window: F freezes, G / Shift+G gain, D / Shift+D depth, R harmonics, C colour Doppler, M measures
/// a distance. With the focus in the view: Esc leaves the tool, Delete removes the selected or else the last
/// measurement, Ctrl+Z and Ctrl+Shift+Z undo and redo; in a frozen loop, Left and Right step, P plays. Mouse: clicks
/// set marks, a drag sets two. Without a tool, a drag moves a mark and selects its measurement, moves the Doppler box,
/// or resizes it by its edges. The wheel steps the frozen loop; Ctrl + wheel magnifies about the pointer, + and - about
/// the middle, 0 shows the whole image; the middle button moves a magnified image.
class UltrasoundView : public QWidget {
  Q_OBJECT
 public:
  explicit UltrasoundView(QWidget* parent = nullptr);
  ~UltrasoundView() override;

  /// Opens another patient; `scene` may follow by set_scene(), `flow` and `panorama` may be nullptr. The controls are
  /// those stored for the transducer; the image is ray cast until the settings select the panorama.
  void show_patient(std::shared_ptr<const ultrasound::AcousticScene> scene,
                    std::shared_ptr<ultrasound::FlowOnDemand> flow, const ultrasound::Transducer& transducer,
                    std::shared_ptr<ultrasound::PanoramaOnDemand> panorama = nullptr);
  /// The scene of the patient that show_patient() opened without one; nullptr changes nothing.
  void set_scene(std::shared_ptr<const ultrasound::AcousticScene> scene);
  void set_transducer_pose(const Pose& X_PT);
  /// Where the patient is; its model is that of the scene's patient.
  void set_motion(const motion::PatientMotion& motion) { motion_ = motion; }
  /// Shaft from the hub to the tip; empty: no needle. `bore_share` and `tip_shift_mm` as in ScanRequest.
  void set_needle(std::span<const Vec3> shaft_P, double diameter_mm, double bore_share = 0.0,
                  double tip_shift_mm = 0.0);
  /// Way of a biopsy gun's stylet if it were fired now, and the notch's part of it; drawn where it is near the plane.
  void set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P);
  /// Called once per frame: requests an image, takes the newest, repaints if necessary. now_s: time of any steady
  /// clock; defines the cardiac phase.
  void advance(double now_s);
  /// The newest image; nullptr before the first.
  std::shared_ptr<const ultrasound::ScanPicture> picture() const { return picture_; }

  /// Sets whether a guide is available; if not, none is shown with any setting.
  void set_guide_offered(bool is_offered);
  bool is_guide_offered() const noexcept { return is_guide_offered_; }
  /// Shows the needle's axis in the image, and the bracket's line if it is mounted.
  void set_guide_visible(bool is_visible);
  bool is_guide_visible() const noexcept { return is_guide_visible_; }

  bool has_scene() const noexcept { return scene_ != nullptr; }
  bool has_panorama() const noexcept { return panorama_ && panorama_->is_possible(); }
  bool has_flow() const noexcept { return flow_ && flow_->is_possible(); }
  const ultrasound::Transducer& transducer() const noexcept { return transducer_; }
  /// Selects another array for the same patient, with its stored controls; the patient's view restarts.
  void choose_transducer(const ultrasound::Transducer& transducer);

  const UltrasoundSettings& settings() const noexcept { return settings_; }
  /// Clamps controls to their ranges. The settings are stored.
  void set_settings(const UltrasoundSettings& settings);
  void change_settings(const std::function<void(UltrasoundSettings&)>& change);
  void reset_settings();
  /// Sets the gain by the next image, as a scanner's button for automatic gain does, and again by the first image of
  /// each case.
  void set_gain_automatically();
  /// Sets the gain by hand; it stays as it is from then on.
  void set_gain(double gain_db);
  /// Tissue harmonic imaging; without effect if the transducer's band has less than an octave. Switched off, the
  /// frequency is the transducer's own again.
  void set_harmonic(bool is_on);
  bool has_harmonic() const noexcept;

  void set_frozen(bool is_frozen);
  bool is_frozen() const { return scanner_.cine().is_frozen; }
  ultrasound::CineState cine() const { return scanner_.cine(); }
  void step_cine(int frames);
  void show_cine(int index);
  void play_cine(bool is_playing);

  void start_measuring(MeasuringTool tool);
  MeasuringTool measuring_tool() const noexcept { return tool_; }
  const ultrasound::Measurements& measurements() const noexcept { return measurements_; }
  void undo_measurement();
  void redo_measurement();
  /// The measurement whose mark was moved last; empty after a click beside all marks.
  std::optional<std::size_t> chosen_measurement() const noexcept { return chosen_; }
  /// True if the pointer is over a mark or drags one.
  bool is_over_mark() const noexcept { return is_over_mark_ || grip_.has_value(); }
  /// Removes the selected measurement, else the last one.
  void remove_measurement();
  void clear_measurements();

  /// Result of the measurement as if the next mark were at the pointer: "Dist 23.4 mm"; empty without a first mark, or
  /// while a further mark is needed.
  QString live_result() const;

  /// Magnification of the image; it is kept until the patient or the transducer changes.
  const PictureZoom& zoom() const noexcept { return zoom_; }
  /// Magnifies about a point of the widget; `factor` is clamped to 1..kMostZoom.
  void zoom_at(const QPointF& place, double factor);
  /// The same about the middle of the picture; by = 1 zooms in, -1 out.
  void zoom_by_steps(int by);
  void reset_zoom();

  /// Mapping between the image plane and the widget, for the newest image.
  std::optional<PictureMap> picture_map() const;
  double frames_per_s() const noexcept { return frames_per_s_; }
  QSize sizeHint() const override { return {640, 560}; }
  QSize minimumSizeHint() const override { return {240, 180}; }

 Q_SIGNALS:
  /// Controls, tool, measurements, freeze state or transducer have changed.
  void changed();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool event(QEvent* event) override;

 private:
  /// A drag of the colour box.
  struct BoxDrag {
    BoxPart part = BoxPart::kWhole;
    ultrasound::DopplerBox begun;
    ultrasound::Vec2 from{0.0, 0.0};
  };

  /// A drag of a mark.
  struct Grip {
    CaliperMark mark;
    ultrasound::Vec2 beside_T{0.0, 0.0};  ///< Offset of the mark from the point at which the drag began.
    bool has_moved = false;
  };

  void make_shortcuts();
  ultrasound::ScanRequest make_request(double now_s);
  std::shared_ptr<const ultrasound::VesselFlow> poll_flow();
  std::shared_ptr<const ultrasound::Panorama> poll_panorama();
  QString flow_message() const;
  QString waiting_text() const;
  void take_picture(double now_s);
  void count_picture(double now_s, bool is_live);
  void save_now();
  void adjust_gain();

  ultrasound::ScanGeometry requested_scan() const;
  MarginSpace room() const;
  const UltrasoundLayout& layout_for(const ultrasound::ScanGeometry& scan) const;
  std::vector<ultrasound::Vec2> guide_line_T() const;
  void set_mark(const ultrasound::Vec2& p_T);
  bool begin_grip(const QPointF& place);
  void move_grip(const ultrasound::Vec2& to_T);
  void forget_choice();
  void set_zoom(const PictureZoom& zoom);
  bool begin_box_drag(const QPointF& place);
  void show_cursor(const QPointF& place);
  bool handle_key(const QKeyEvent& event, bool is_rehearsal);
  void leave_tool();
  void measurements_changed();

  ultrasound::LiveScanner scanner_;
  std::shared_ptr<const ultrasound::AcousticScene> scene_;
  std::shared_ptr<ultrasound::FlowOnDemand> flow_;
  std::shared_ptr<ultrasound::PanoramaOnDemand> panorama_;
  bool is_flow_awaited_ = false;  ///< Until the first image with colour after the computation.
  ultrasound::Transducer transducer_;
  UltrasoundSettings settings_;
  bool is_saving_wanted_ = false;
  bool is_gain_wanted_ = false;  ///< The next image sets the gain.
  double changed_s_ = 0.0, now_s_ = 0.0;

  PictureZoom zoom_;
  std::optional<QPointF> panned_from_;  ///< Last place of a drag that moves the magnified image.
  std::optional<ultrasound::AcousticOutput> output_;

  std::optional<Pose> X_PT_;
  motion::PatientMotion motion_;
  std::vector<Vec3> needle_shaft_P_;
  double needle_diameter_mm_ = 1.2, needle_bore_share_ = 0.0, tip_shift_mm_ = 0.0;
  std::optional<Segment> throw_P_, notch_P_;
  bool is_guide_visible_ = false, is_guide_offered_ = true;

  std::shared_ptr<const ultrasound::ScanPicture> picture_;
  QImage image_;  ///< Refers to the pixels of picture_, which it does not own.
  double frames_per_s_ = 0.0, counting_since_s_ = -1.0;
  int counted_ = 0;
  ultrasound::CineState shown_cine_;

  MeasuringTool tool_ = MeasuringTool::kNone;
  ultrasound::Measurements measurements_;
  std::vector<ultrasound::Vec2> marks_T_;  ///< Marks of an unfinished measurement.
  ultrasound::Vec2 hover_T_{0.0, 0.0};
  QPointF pressed_at_;
  bool is_pressed_ = false;
  std::optional<BoxDrag> box_drag_;
  std::optional<Grip> grip_;
  std::optional<std::size_t> chosen_;
  bool is_over_mark_ = false;

  struct LayoutKey {
    QSizeF view, caption, bars;
    ultrasound::ScanGeometry scan;
  };
  mutable std::optional<LayoutKey> layout_key_;
  mutable UltrasoundLayout layout_;
};

}  // namespace trocar::trainer
