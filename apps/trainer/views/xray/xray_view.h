#pragma once

#include <QImage>
#include <QPointF>
#include <QWidget>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "anatomy/patient.h"
#include "core/background_job.h"
#include "tasks/needle.h"
#include "tasks/xray_use.h"
#include "views/xray/xray_settings.h"
#include "xray/contrast/live_contrast.h"
#include "xray/fluoroscopy/live_fluoroscope.h"
#include "xray/geometry/c_arm_presets.h"

namespace trocar::trainer {

/// Screen of a fluoroscope: the live image while the pedal is down, otherwise the last one, with dose and position of
/// the C-arm. Separate threads prepare the patient (when the view is first visible), compute the images and move the
/// contrast agent; no function blocks.
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
  /// Shaft from the hub to the tip; empty: no needle.
  void set_needle(std::span<const Vec3> shaft_P) { shaft_P_.assign(shaft_P.begin(), shaft_P.end()); }
  /// Called once per frame: requests an image, takes the newest, repaints if necessary. now_s: time of any steady
  /// clock.
  void advance(double now_s);

  const XraySettings& settings() const noexcept { return settings_; }
  /// Clamps C-arm and collimation to the unit's ranges.
  void change_settings(const std::function<void(XraySettings&)>& change);
  const xray::CArmPreset& unit() const noexcept { return unit_; }

  void set_pedal(bool is_down);
  bool is_pedal_down() const noexcept { return is_pedal_down_; }
  void set_injecting(bool is_injecting);
  bool is_injecting() const noexcept { return is_injecting_; }

  /// The newest image; nullptr before the first.
  std::shared_ptr<const xray::FluoroscopyFrame> frame() const { return frame_; }
  /// State of the examination; its time is not set.
  tasks::XrayUse use() const;
  /// What the tip is in, as far as contrast agent matters.
  std::shared_ptr<const xray::ContrastState> contrast() const { return contrast_.newest(); }

  QSize sizeHint() const override { return {640, 640}; }
  QSize minimumSizeHint() const override { return {240, 240}; }
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void changed();

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
  };
  void prepare();
  xray::FluoroscopyRequest make_request(double now_s) const;
  QRectF image_rect() const;
  void draw_texts(QPainter& painter) const;
  QString message() const;

  xray::CArmPreset unit_;
  XraySettings settings_;
  tasks::Needle needle_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::function<Vec3()> find_middle_P_;
  BackgroundJob<Prepared> preparing_;
  bool has_volume_ = false;
  QString failure_;
  std::unique_ptr<xray::LiveFluoroscope> fluoroscope_;
  xray::LiveContrast contrast_;
  std::vector<Vec3> shaft_P_;
  bool is_pedal_down_ = false, is_injecting_ = false;
  double opened_s_ = -1.0;
  std::shared_ptr<const xray::FluoroscopyFrame> frame_;
  QImage image_;  ///< Refers to the pixels of frame_.
  QPointF dragged_from_;
};

}  // namespace trocar::trainer
