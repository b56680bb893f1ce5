#include "haptics/insertion/needle_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/proxy/tip_law.h"

namespace trocar::haptics {
namespace {

/// A hand moves a needle by less than this in a tick.
constexpr double kNeedleJump_mm = 5.0;
constexpr double kNeedleJump_mm_per_s = 3000.0;

/// Starts at the needle's pose: outside, or inside with all layers down to the tip pierced.
void start(NeedleState& state, const PatientNow& now, const Pose& X_PN, NeedleStep& step) noexcept {
  leave_body(state.path);
  const Vec3 axis_P = X_PN.R().col(2);
  step.has_resumed = resume_inside(state.path, now, X_PN.p(), axis_P);
  start_insertion(state.insertion, state.path, now, X_PN.p(), std::exchange(state.pressed_mm, 0.0));
  start_proxy_needle(state.proxy, state.path, X_PN.p(), now.motion);
  state.X_PN = X_PN;
  state.tip_velocity_P = state.axis_rate_P = Vec3::Zero();
  state.is_started = true;
  state.is_torn = false;
}

/// True for a tip that is inside the body without path or contact: it left its channel sideways.
bool is_lost_inside(const NeedleState& state, const PatientNow& now, const Vec3& tip_P) noexcept {
  if (state.path.is_open || state.insertion.loading != kNoLayer || state.proxy.is_on_skin) return false;
  constexpr double kLost_mm = 1.0;
  const double deeper_mm = kLost_mm + state.insertion.recoil_mm;
  return skin_distance_mm(now, tip_P) < -deeper_mm && skin_distance_mm(now, state.X_PN.p()) < -deeper_mm;
}

/// The pose one damping time ahead: springs at this pose damp in proportion to their stiffness (physics.md B7).
Pose pose_ahead(NeedleState& state, const Pose& X_PN, double ahead_s, double dt_s) noexcept {
  const double share = dt_s / (dt_s + kVelocitySmoothing_s);
  const Vec3 axis = X_PN.R().col(2);
  state.tip_velocity_P += share * ((X_PN.p() - state.X_PN.p()) / dt_s - state.tip_velocity_P);
  state.axis_rate_P += share * ((axis - state.X_PN.R().col(2)) / dt_s - state.axis_rate_P);
  const Vec3 ahead = (axis + ahead_s * state.axis_rate_P).normalized();
  return {rotation_between(axis, ahead) * X_PN.R(), X_PN.p() + ahead_s * state.tip_velocity_P};
}

/// A needle beside `line` as it is beside a line that has moved on: damping counts motion against the patient's.
NeedleAtPath seen_from(const PathLine& moved, const PathLine& line, NeedleAtPath needle) noexcept {
  const Mat3 back = rotation_between(moved.direction_P, line.direction_P);
  needle.stylus_P = line.origin_P + back * (needle.stylus_P - moved.origin_P);
  needle.axis_P = back * needle.axis_P;
  return needle;
}

NeedleAtPath at_path(const HapticScene& scene, const Pose& X_PN) noexcept {
  const Vec3 axis_P = X_PN.R().col(2);
  return {X_PN.p() - scene.needle.length_mm * axis_P, axis_P, scene.needle.length_mm};
}

/// Line to which paper A holds a needle, which does not bend: the channel's, `ahead_s` ahead in time where the patient
/// moves.
PathLine path_line(const InsertionPath& path, const PatientNow& now, double ahead_s) noexcept {
  const Channel& channel = path.channel;
  if (channel.nodes.count == 0) return {channel.origin_P, channel.direction_P};
  const ChannelLine line = needle_line(channel, now.motion, path.rest_mm, ahead_s);
  return {line.origin_P, line.direction_P};
}

/// Paper A: path constraint after the skin puncture, about S.
Wrench path_constraint_wrench(const InsertionPath& path, const PatientNow& now, const Pose& X_PN,
                              const Pose& X_PN_ahead) noexcept {
  if (!path.is_open) return {};
  const HapticScene& scene = now.scene;
  const NeedleAtPath needle = at_path(scene, X_PN), ahead = at_path(scene, X_PN_ahead);
  const PathLine line = path_line(path, now, 0.0);
  if (path.channel.nodes.count == 0) return path_constraint(line, needle, ahead, scene.options.constraint);
  const PathLine line_ahead = path_line(path, now, scene.options.coupling.damping_time_s());
  return path_constraint(line, needle, seen_from(line_ahead, line, ahead), scene.options.constraint);
}

/// Torque about S of resistances along the path: they act at the tip, from whose motion they are computed (physics.md
/// T1).
Vec3 axial_torque_nmm(const HapticScene& scene, const Pose& X_PN, const Vec3& direction_P, double along_n) noexcept {
  return -along_n * Vec3(scene.needle.length_mm * X_PN.R().col(2)).cross(direction_P);
}

/// Force across the needle on unpierced skin, whose whole force is along the contact's way, at the tip; damped like the
/// force along it (physics.md V2).
void hold_on_skin(const NeedleState& state, const HapticScene& scene, const Pose& X_PN, const Pose& X_PN_ahead,
                  NeedleStep& step) noexcept {
  if (!step.axial.is_on_skin) return;
  const SkinContact& skin = state.insertion.skin;
  const double load_n = step.axial.prepuncture_n;
  const double ahead_s = scene.options.coupling.damping_time_s();
  Vec3 force_P = load_n * (step.axial.axis_P - skin.way_P);
  constexpr double kNear_mm = 1e-6;
  if (skin.to_device_mm > kNear_mm) {
    const Vec3 ahead_P = X_PN_ahead.p() - X_PN.p() - ahead_s * skin.slides_P;
    force_P -= load_n / skin.to_device_mm * (ahead_P - skin.way_P * skin.way_P.dot(ahead_P));
  }
  step.held_P.force_n += force_P;
  step.held_P.torque_nmm += Vec3(scene.needle.length_mm * X_PN.R().col(2)).cross(force_P);
}

/// Depth of the virtual needle's tip along the path: it grows evenly where a layer is pressed in, too.
double needle_depth_mm(const NeedleState& state, const HapticScene& scene) noexcept {
  const bool is_proxy = scene.options.force_model == ForceModel::kProxy;
  return std::max(0.0, is_proxy ? state.proxy.needle_mm : state.insertion.s_mm);
}

/// Change of the share that is rendered per mm of depth: the grip's rotational stiffness between the last two depths.
double share_slope_per_mm(GripTurning& turning, const HeldShaft& shaft, double tip_mm) noexcept {
  constexpr double kMoved_mm = 1e-3;
  if (std::abs(tip_mm - turning.tip_mm) > kMoved_mm) {
    turning.slope =
        turning.nmm_per_rad > 0.0 ? (shaft.turning_nmm_per_rad - turning.nmm_per_rad) / (tip_mm - turning.tip_mm) : 0.0;
    turning.tip_mm = tip_mm;
    turning.nmm_per_rad = shaft.turning_nmm_per_rad;
  }
  return shaft.share < 1.0 ? -shaft.share * turning.slope / shaft.turning_nmm_per_rad : 0.0;
}

/// Forces of the body proxies across the path, the bent shape of the needle, and the torque about the grip of all
/// forces (paper B, eq. 6): those along the path act at the tip, from whose motion they are computed.
void hold_body(NeedleState& state, const PatientNow& now, const Pose& X_PN, const Pose& X_PN_ahead, bool is_stylet_in,
               double cutting_mm_per_s, NeedleStep& step) noexcept {
  const HapticScene& scene = now.scene;
  state.bent.node_count = 0;
  const InsertionStep& axial = step.axial;
  step.held_P.force_n = -axial.bed_n * axial.axis_P;
  const double on_tip_n = axial.prepuncture_n + axial.cutting_n - step.tip_proxy_P.dot(axial.axis_P);
  const double along_n = on_tip_n + axial.friction_n + axial.body_axial_n + axial.stick_n + axial.bed_n;
  step.held_P.torque_nmm = axial_torque_nmm(scene, X_PN_ahead, axial.axis_P, along_n);
  if (!state.path.is_open) {  // the tip proxy's force across the needle; nothing holds the shaft yet
    const Vec3 across_P = step.tip_proxy_P - axial.axis_P * step.tip_proxy_P.dot(axial.axis_P);
    step.held_P.torque_nmm += Vec3(scene.needle.length_mm * X_PN_ahead.R().col(2)).cross(across_P);
    return;
  }
  const double depth_mm = needle_depth_mm(state, scene);
  const HeldShaft shaft =
      hold_shaft(state.path.channel, now, X_PN_ahead, depth_mm, is_stylet_in, scene.options.coupling.damping_time_s());
  state.is_torn = is_torn(state.path.channel, now, X_PN, depth_mm);
  // The bevel deflects only while it cuts: at rest, or against a layer that holds, its force would have no potential.
  const double cuts = cutting_mm_per_s > 0.0 ? motion_fade(cutting_mm_per_s) : 0.0;
  const ShaftReaction reaction =
      react(shaft, scene, bevel_force_P(scene.needle, X_PN_ahead, cuts * (on_tip_n - axial.prepuncture_n)));
  state.bent = reaction.bent;
  state.path.bed_out_n =
      shaft.out_n + share_slope_per_mm(state.turning, shaft, depth_mm) / shaft.share * shaft.energy_nmm;
  state.path.bed_out_n_per_mm = std::max(0.0, shaft.out_n_per_mm);
  step.held_P.force_n += reaction.wrench_P.force_n;
  step.held_P.torque_nmm += reaction.wrench_P.torque_nmm;
}

/// Contribution of model B along the path in the combined model: the shaft's friction, and the tip in tissue that model
/// A does not include.
ProxyShare proxy_share(const InsertionPath& path, const PatientNow& now) noexcept {
  const HapticScene& scene = now.scene;
  ProxyShare share;
  if (!path.is_open) return share;
  share.shaft = shaft_resistance(path.channel, scene, path.rest_mm);
  const auto bin = static_cast<std::size_t>(bin_of(path.rest_mm));
  const TissueAt here{path.channel.tissue[bin], path.channel.label[bin]};
  if (!(path.rest_mm > 0.0) || !is_read_from_ct(scene, here)) return share;
  const ChannelNow course(path.channel, now.motion);
  const TipLaw law = tip_law_now(now, course.rest_A(path.rest_mm), here);
  share.tip_n = threshold_along_n(law, path.channel.direction_P);
  share.tip_viscous_ns_per_mm = (1.0 - law.border) * law.law.viscosity_ns_per_mm;
  return share;
}

/// Paper A's path constraint instead of the bending shaft (C3, C4).
void constrain_to_path(NeedleState& state, const PatientNow& now, const Pose& X_PN, const Pose& X_PN_ahead,
                       NeedleStep& step) noexcept {
  step.held_P = path_constraint_wrench(state.path, now, X_PN, X_PN_ahead);
  const InsertionStep& axial = step.axial;
  const double along_n = axial.prepuncture_n + axial.friction_n + axial.cutting_n + axial.stick_n;
  step.held_P.torque_nmm += axial_torque_nmm(now.scene, X_PN, axial.axis_P, along_n);
}

void step_insertion_model(NeedleState& state, const PatientNow& now, const Pose& X_PN, const Pose& X_PN_ahead,
                          bool is_stylet_in, double dt_s, NeedleStep& step) noexcept {
  constexpr double kNoBevel = 0.0;  // paper A has no force on the bevel
  step.axial = step_insertion(state.insertion, state.path, now, X_PN.p(), X_PN.R().col(2), dt_s);
  if (now.scene.has_path_constraint)
    constrain_to_path(state, now, X_PN, X_PN_ahead, step);
  else
    hold_body(state, now, X_PN, X_PN_ahead, is_stylet_in, kNoBevel, step);
  hold_on_skin(state, now.scene, X_PN, X_PN_ahead, step);
}

void step_proxy_model(NeedleState& state, const PatientNow& now, const Pose& X_PN, const Pose& X_PN_ahead,
                      bool is_stylet_in, double dt_s, NeedleStep& step) noexcept {
  const Vec3 proxy_before_P = state.proxy.proxy_P;
  const ProxyNeedleStep moved = step_proxy_needle(state.proxy, state.path, now, X_PN, X_PN_ahead, dt_s);
  step.axial = moved.axial;
  step.tip_proxy_P = moved.tip_force_P;
  const double cutting_mm_per_s = (state.proxy.proxy_P - proxy_before_P).dot(step.axial.axis_P) / dt_s;
  hold_body(state, now, X_PN, X_PN_ahead, is_stylet_in, cutting_mm_per_s, step);
}

void step_combined_model(NeedleState& state, const PatientNow& now, const Pose& X_PN, const Pose& X_PN_ahead,
                         bool is_stylet_in, double dt_s, NeedleStep& step) noexcept {
  const ProxyShare share = proxy_share(state.path, now);
  step.axial = step_insertion(state.insertion, state.path, now, X_PN.p(), X_PN.R().col(2), dt_s, &share);
  step.tip_proxy_P = -step.axial.tip_proxy_n * step.axial.axis_P;
  hold_body(state, now, X_PN, X_PN_ahead, is_stylet_in, step.axial.velocity_mm_per_s, step);
  hold_on_skin(state, now.scene, X_PN, X_PN_ahead, step);
}

/// Where the patient moves: what is fixed to tissue, to where that is now.
void carry_with_tissue(NeedleState& state, const PatientNow& now) noexcept {
  if (now.motion.is_rest()) return;
  if (state.proxy.is_on_skin) state.proxy.proxy_P = now.motion.to_now(state.proxy.skin.anchor_A);
  if (!state.path.is_open || state.path.channel.nodes.count == 0) return;
  const bool is_proxy = now.scene.options.force_model == ForceModel::kProxy;
  carry(state.path.channel, now, is_proxy ? state.proxy.along_mm : state.insertion.s_mm);
  if (is_proxy) carry_proxy(state.proxy, state.path.channel);
}

/// A tick without any bend that can be seen is sent as straight.
constexpr double kStraight_mm = 0.02;
static_assert(kMaxBeamNodes <= telemetry::NeedleShape::kMostSpans);

}  // namespace

telemetry::NeedleShape needle_shape(const NeedleState& state, const PatientNow& now, bool is_stylet_in) noexcept {
  const HapticScene& scene = now.scene;
  telemetry::NeedleShape shape;
  if (!state.path.is_open) return shape;
  BentShaft bent = state.bent;
  if (scene.has_path_constraint) {
    const HeldShaft shaft = hold_shaft(state.path.channel, now, state.X_PN, state.path.rest_mm, is_stylet_in);
    bent = react(shaft, scene, Vec3::Zero()).bent;
  }
  const Mat3& R_PN = state.X_PN.R();
  double largest_mm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(bent.node_count); ++i) {
    const double x = R_PN.col(0).dot(bent.deflection_mm[i]), y = R_PN.col(1).dot(bent.deflection_mm[i]);
    shape.beside_mm[i] = {static_cast<float>(x), static_cast<float>(y)};
    largest_mm = std::max(largest_mm, std::hypot(x, y));
  }
  if (largest_mm > kStraight_mm && largest_mm < telemetry::kMostBeside_mm)
    shape.spans = static_cast<std::uint8_t>(bent.node_count);
  return shape;
}

NeedleStep step_needle(NeedleState& state, const PatientNow& now, const Pose& X_PN, bool is_stylet_in,
                       double dt_s) noexcept {
  NeedleStep step;
  const double way_mm = (X_PN.p() - state.X_PN.p()).norm();
  step.has_jumped = state.is_started && way_mm > kNeedleJump_mm + kNeedleJump_mm_per_s * dt_s;
  if (!state.is_started || step.has_jumped || state.is_torn || is_lost_inside(state, now, X_PN.p()))
    start(state, now, X_PN, step);
  else
    carry_with_tissue(state, now);
  const Pose X_PN_ahead = pose_ahead(state, X_PN, now.scene.options.coupling.damping_time_s(), dt_s);
  switch (now.scene.options.force_model) {
    case ForceModel::kInsertion:
      step_insertion_model(state, now, X_PN, X_PN_ahead, is_stylet_in, dt_s, step);
      break;
    case ForceModel::kProxy:
      step_proxy_model(state, now, X_PN, X_PN_ahead, is_stylet_in, dt_s, step);
      break;
    case ForceModel::kCombined:
      step_combined_model(state, now, X_PN, X_PN_ahead, is_stylet_in, dt_s, step);
      break;
  }
  state.X_PN = X_PN;
  return step;
}

}  // namespace trocar::haptics
