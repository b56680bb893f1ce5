// The replay of a recorded attempt.
#include <algorithm>
#include <cmath>
#include <utility>

#include "views/xray/xray_view.h"

namespace trocar::trainer {
namespace {

/// Recorded angles, isocentre and field; the rest is that of another one.
xray::CArm c_arm_of(const tasks::XrayUse& use, xray::CArm arm) {
  arm.lao_deg = use.lao_deg;
  arm.cranial_deg = use.cranial_deg;
  arm.isocentre_P = use.isocentre_P;
  arm.field_mm = use.field_mm;
  return arm;
}

}  // namespace

void XrayView::begin_replay(std::shared_ptr<const attempt::InjectionSteps> injections) {
  const std::array<double, 2> collimation = settings_.arm.collimation;
  clear_examination();
  change_settings([&](XraySettings& s) { s.arm.collimation = collimation; });
  if (contrast_.states().value()) {  // otherwise it still follows the ducts, and closing would wait
    contrast_.close();
    is_contrast_open_ = false;
  }
  replay_.emplace();
  replay_->injections = std::move(injections);
  setToolTip(tr("The X-ray images of the attempt, with the recorded C-arm, dose and contrast agent"));
  Q_EMIT changed();
}

void XrayView::end_replay() {
  if (replay_ && replay_->fluoroscope)
    retired_.retire(
        BackgroundJob<bool>([old = std::move(replay_->fluoroscope)](const Progress&) mutable -> Result<bool> {
          old.reset();
          return true;
        }));
  replay_.reset();
}

void XrayView::show_moment(const std::optional<attempt::XrayMoment>& moment, std::vector<Vec3> shaft_P) {
  if (!replay_) return;
  replay_->moment = moment;
  replay_->shaft_P = std::move(shaft_P);
  if (!moment || !moment->image_s) {
    frame_.reset();
    image_ = {};
  }
  xray::CArm arm = unit_.arm;
  if (prepared_) arm.isocentre_P = prepared_->middle_P;
  if (moment) arm = c_arm_of(moment->use, arm);
  arm.collimation = settings_.arm.collimation;
  arm == settings_.arm ? update() : change_settings([&](XraySettings& s) { s.arm = arm; });
}

double XrayView::pulse_s(double time_s) const {
  constexpr double kRounding = 1e-6;
  return std::floor(time_s * settings_.pulses_per_s + kRounding) / settings_.pulses_per_s;
}

void XrayView::advance_replay() {
  Replay& replay = *replay_;
  if (!replay.moment || !replay.moment->image_s) return;
  if (!replay.fluoroscope)
    replay.fluoroscope = std::make_unique<ReplayFluoroscope>(
        ReplayXraySource{patient_, prepared_->volume, prepared_->blood, replay.injections}, fluoroscope_options());
  const attempt::XrayMoment& moment = *replay.moment;
  ReplayXrayRequest request;
  request.image_s = *moment.image_s;
  request.is_injecting = moment.is_injecting_then;
  request.scene = make_request(replay.shaft_P, moment.is_injecting_then);
  request.scene.arm = c_arm_of(moment.image, settings_.arm);
  replay.fluoroscope->request(std::move(request));
  auto newest = replay.fluoroscope->frames().value();
  // After a black screen, an image of another time would be wrong.
  if (!frame_ && newest && newest->time_s != *moment.image_s) newest.reset();
  take(std::move(newest), replay.fluoroscope->error());
}

bool XrayView::is_complete() const {
  if (!replay_ || !replay_->moment || !replay_->moment->image_s) return frame_ == nullptr;
  return frame_ && frame_->time_s == *replay_->moment->image_s;
}

bool XrayView::is_held() const {
  if (replay_) return replay_->moment && replay_->moment->is_held();
  return !frame_ || frame_->is_held;
}

QString XrayView::replay_message() const {
  constexpr double kLate_s = 1.0;
  if (!replay_->moment || !replay_->moment->image_s) return tr("No X-rays yet");
  if (!frame_ || std::abs(frame_->time_s - *replay_->moment->image_s) > kLate_s) return tr("Computing the image");
  return {};
}

}  // namespace trocar::trainer
