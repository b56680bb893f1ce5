#include "devices/workspace_map.h"

#include "devices/haptic_device.h"

namespace trocar::devices {
namespace {

Pose shown(const WorkspaceState& state, double motion_scale, const Pose& X_DS) noexcept {
  const Pose& X_WD = state.X_WD_now;
  return {X_WD.R() * X_DS.R() * state.R_SS_now, X_WD * Vec3(motion_scale * X_DS.p())};
}

/// Moves base and tool so that this reading maps to the pose held by the clutch.
void release(WorkspaceState& state, double motion_scale, const Pose& X_DS) noexcept {
  const Mat3& R_WD = state.X_WD_now.R();
  state.R_SS_now = (R_WD * X_DS.R()).transpose() * state.X_WS_held.R();
  state.X_WD_now = Pose(R_WD, state.X_WS_held.p() - R_WD * (motion_scale * X_DS.p()));
  state.is_clutched = false;
}

}  // namespace

WorkspaceParams workspace_params(const haptics::DevicePreset& preset) noexcept {
  WorkspaceParams params{preset.X_WD, preset.motion_scale, preset.force_scale, 0};
  if (preset.clutch_button == 1) params.clutch = kButtonMain;
  if (preset.clutch_button == 2) params.clutch = kButtonSecond;
  return params;
}

Pose map_to_room(WorkspaceState& state, const WorkspaceParams& params, const Pose& X_DS,
                 std::uint32_t buttons) noexcept {
  if (!state.is_started) {
    state = {};
    state.X_WD_now = params.X_WD;
    state.is_started = true;
  }
  if (!X_DS.is_finite()) return X_DS;
  const bool is_pressed = (buttons & params.clutch) != 0;
  if (is_pressed && !state.is_clutched) {
    state.X_WS_held = shown(state, params.motion_scale, X_DS);
    state.is_clutched = true;
  }
  if (!is_pressed && state.is_clutched) release(state, params.motion_scale, X_DS);
  return state.is_clutched ? state.X_WS_held : shown(state, params.motion_scale, X_DS);
}

Pose map_from_room(const WorkspaceState& state, const WorkspaceParams& params, const Pose& X_WS) noexcept {
  const Pose& X_WD = state.is_started ? state.X_WD_now : params.X_WD;
  return {X_WD.R().transpose() * X_WS.R() * state.R_SS_now.transpose(),
          X_WD.inverse() * X_WS.p() / params.motion_scale};
}

Wrench map_to_device(const WorkspaceState& state, const WorkspaceParams& params, const Wrench& wrench_W) noexcept {
  if (state.is_clutched) return {};
  const Mat3 R_DW = (state.is_started ? state.X_WD_now : params.X_WD).R().transpose();
  return {R_DW * wrench_W.force_n * params.force_scale, R_DW * wrench_W.torque_nmm * params.force_scale};
}

}  // namespace trocar::devices
