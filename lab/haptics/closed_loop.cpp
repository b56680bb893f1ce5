#include "lab/haptics/closed_loop.h"

#include <utility>

namespace trocar::haptics {

const char* to_string(Holder holder) noexcept {
  switch (holder) {
    case Holder::kHand:
      return "hand";
    case Holder::kGuidingHand:
      return "at the tip";
    case Holder::kBare45g:
      return "bare 45 g";
    case Holder::kBare150g:
      return "bare 150 g";
  }
  return "";
}

ClosedLoop::ClosedLoop(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset, Holder holder,
                       double dt_s)
    : scene_(std::move(scene)), encoder_(preset.encoder), senses_rotation_(preset.sensed_dof == 6), dt_s_(dt_s) {
  constexpr double kLight_kg = 0.045;
  constexpr double kHeavy_kg = 0.15;
  params_.mass_kg = preset.apparent_mass_kg;
  if (holder == Holder::kBare45g) params_.mass_kg = kLight_kg;
  if (holder == Holder::kBare150g) params_.mass_kg = kHeavy_kg;
  params_.weight_n = preset.capability.stylus_weight_n;
  // A device without torque cannot carry a lever: its gimbal is balanced.
  params_.weight_lever_mm = preset.has_torque() ? preset.capability.stylus_lever_mm : 0.0;
}

const telemetry::TickSample& ClosedLoop::carry(const Vec3& tip_P, const Vec3& axis_P) noexcept {
  const Pose X_PS = needle_pose(tip_P, axis_P) * scene_->X_SN.inverse();
  stylus_.v_P = time_s_ > 0.0 ? Vec3((X_PS.p() - stylus_.X_PS.p()) / dt_s_) : Vec3::Zero();
  stylus_.w_P = Vec3::Zero();
  stylus_.X_PS = X_PS;
  reported_R_PS_ = X_PS.R();
  return sense();
}

const telemetry::TickSample& ClosedLoop::run(const stylus::StylusHold& hold) noexcept {
  const stylus::StylusMotion motion = stylus::step_stylus(stylus_, params_, hold, acting_P_, scene_->gravity_P, dt_s_);
  observer_.add(acting_P_ - weight_P_, motion.v_P, motion.w_P, dt_s_);
  return sense();
}

const telemetry::TickSample& ClosedLoop::sense() noexcept {
  time_s_ += dt_s_;
  Pose X_WS = stylus::quantise(scene_->X_PW.inverse() * stylus_.X_PS, encoder_);
  if (!senses_rotation_) X_WS = Pose(scene_->X_PW.R().transpose() * reported_R_PS_, X_WS.p());
  HapticInput input;
  input.time_s = time_s_;
  input.dt_s = dt_s_;
  input.tool = tool_pose(*scene_, X_WS);
  const HapticOutput output = tick(state_, input, *scene_);
  sample_ = output.sample;
  const Mat3& R_PW = scene_->X_PW.R();
  acting_P_ = std::exchange(wrench_P_, R_PW * output.total_W);
  weight_P_ = std::exchange(next_weight_P_, R_PW * output.weight_W);
  return sample_;
}

}  // namespace trocar::haptics
