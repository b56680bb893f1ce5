#pragma once

#include <QImage>
#include <QPointF>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "anatomy/patient.h"
#include "attempt/record/xray_replay.h"
#include "core/background_job.h"
#include "motion/patient_motion.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "views/xray/replay_fluoroscope.h"
#include "views/xray/xray_settings.h"
#include "xray/contrast/contrast_flow.h"
#include "xray/fluoroscopy/live_fluoroscope.h"
#include "xray/geometry/c_arm.h"
#include "xray/tools/tool_shape.h"

namespace trocar::trainer {

/// Screen of a fluoroscope: the live image while the pedal is down, otherwise the last one, with dose and position of
/// the C-arm. Separate threads prepare the patient (when the view is first visible), compute the images and move the
/// contrast agent; no function blocks. In the replay of an attempt it shows the recorded use: the images of each moment
/// are computed again, and keys, mouse and controls do not act.
///
/// Keys, in the whole window while the view is visible: Z held is the pedal, J held injects contrast agent at the
/// needle's tip. Mouse: the left button moves the table, the right button turns the C-arm, the wheel changes the field.
class XrayView : public QWidget {
  Q_OBJECT
 public:
  explicit XrayView(QWidget* parent = nullptr);
  ~XrayView() override;

  /// Opens another patient: removes images, dose and contrast agent. `find_middle_P`: the isocentre to begin with;
  /// called on a thread.
  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient, const tasks::Needle& needle,
                    std::function<Vec3()> find_middle_P);
  /// A new examination of the same patient: without images, dose and contrast agent, C-arm and table as at first. Ends
  /// a replay.
  void begin();
  /// Shows the moments of a recorded attempt of this patient from now on. Pulse rate, dose mode and collimation are not
  /// recorded: they stay as they are.
  void begin_replay(std::shared_ptr<const attempt::InjectionSteps> injections);
  /// In a replay. Empty: before the first use. `shaft_P`: the needle at the time of the image.
  void show_moment(const std::optional<attempt::XrayMoment>& moment, std::vector<Vec3> shaft_P);
  bool is_replay() const noexcept { return replay_.has_value(); }
  /// In a replay: true if the image of the moment is displayed, or the moment has none.
  bool is_complete() const;
  /// The pulse that is displayed at a time: the last one of the pulse rate.
  double pulse_s(double time_s) const;

  /// Where the patient is; its model belongs to the patient.
  void set_motion(const motion::PatientMotion& motion) { motion_ = motion; }
  /// Shaft from the hub to the tip; empty: no needle. Not used in a replay.
  void set_needle(std::span<const Vec3> shaft_P) { shaft_P_.assign(shaft_P.begin(), shaft_P.end()); }
  /// Guide wire: where it left the needle, and its length and direction if it went straight on; in a duct it follows
  /// the duct. Empty: none.
  void set_wire(const std::optional<Segment>& wire_P) { wire_P_ = wire_P; }
  /// Called once per frame: requests an image, takes the newest, repaints if necessary. now_s: time of any steady
  /// clock.
  void advance(double now_s);
  /// Takes a step of the preparation of the patient's images, which a thread computes; advance() does, too.
  void prepare();

  const XraySettings& settings() const noexcept { return settings_; }
  /// Clamps C-arm and collimation to the unit's ranges.
  void change_settings(const std::function<void(XraySettings&)>& change);
  const xray::CArmPreset& unit() const noexcept { return unit_; }

  void set_pedal(bool is_down);
  bool is_pedal_down() const noexcept { return is_pedal_down_; }
  /// Refused, with injection_refused, where there is a hindrance.
  void set_injecting(bool is_injecting);
  /// Why nothing can be injected now, for the trainee; ends an injection. Empty: it can.
  void set_injection_hindrance(const QString& reason);
  /// While the attempt is interrupted nothing flows; an injection goes on after it if its key is still held.
  void pause_injection(bool is_paused) noexcept { is_injection_paused_ = is_paused; }
  bool is_injecting() const noexcept { return is_injecting_ && !is_injection_paused_; }

  /// The newest image; nullptr before the first. In a replay, time_s is its session time, and its dose is of no
  /// examination.
  std::shared_ptr<const xray::FluoroscopyFrame> frame() const { return frame_; }
  /// State of the examination, without its time; in a replay the recorded one.
  tasks::XrayUse use() const;
  /// What the tip is in, as far as contrast agent matters.
  std::shared_ptr<const xray::ContrastState> contrast() const { return contrast_.states().value(); }

  QSize sizeHint() const override { return {640, 640}; }
  QSize minimumSizeHint() const override { return {240, 240}; }
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void changed();
  /// Somebody wanted to inject contrast agent, which is not possible for this reason.
  void injection_refused(const QString& reason);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Prepared {
    std::shared_ptr<const xray::XrayVolume> volume;
    Vec3 middle_P;
    xray::BloodVelocity blood;  ///< Empty: no vessel has flow.
    xray::DuctTree ducts;       ///< Empty: no duct is labelled.
    xray::ToolKind wire;
  };
  /// A replay and its present moment.
  struct Replay {
    std::shared_ptr<const attempt::InjectionSteps> injections;
    std::optional<attempt::XrayMoment> moment;
    std::vector<Vec3> shaft_P;
    std::unique_ptr<ReplayFluoroscope> fluoroscope;  ///< nullptr before the patient is prepared.
  };

  void clear_examination();
  void open_contrast();
  void draw_sides(QPainter& painter) const;
  void end_replay();
  void advance_live(double now_s);
  void advance_replay();
  void take(std::shared_ptr<const xray::FluoroscopyFrame> newest, const std::optional<Error>& error);
  xray::LiveFluoroscopeOptions fluoroscope_options() const;
  xray::FluoroscopyRequest make_request(std::span<const Vec3> shaft_P, bool is_injecting) const;
  xray::ToolShape make_wire() const;
  bool is_held() const;
  QRectF image_rect() const;
  void draw_texts(QPainter& painter) const;
  QString message() const;
  QString replay_message() const;

  xray::CArmPreset unit_;
  XraySettings settings_;
  tasks::Needle needle_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::function<Vec3()> find_middle_P_;
  BackgroundJob<Prepared> preparing_;
  std::optional<Prepared> prepared_;
  QString failure_;
  std::unique_ptr<xray::LiveFluoroscope> fluoroscope_;
  xray::LiveContrast contrast_;
  bool is_contrast_open_ = false;
  std::optional<Replay> replay_;
  RetiredJobs retired_;  ///< The ends of former replays, which may wait for an image.
  std::vector<Vec3> shaft_P_;
  motion::PatientMotion motion_;
  std::optional<Segment> wire_P_;
  bool is_pedal_down_ = false, is_injecting_ = false, is_injection_paused_ = false;
  QString injection_hindrance_;
  double opened_s_ = -1.0;
  std::shared_ptr<const xray::FluoroscopyFrame> frame_;
  QImage image_;  ///< Refers to the pixels of frame_.
  QPointF dragged_from_;
};

}  // namespace trocar::trainer
