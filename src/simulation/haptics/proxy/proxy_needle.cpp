#include "haptics/proxy/proxy_needle.h"

#include <algorithm>
#include <cmath>

#include "haptics/insertion/insertion_law.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/tip_law.h"
#include "volume/sampling.h"

namespace trocar::haptics {
namespace {

constexpr double kAtWall_mm = 1e-6;
constexpr double kHole_mm = 0.2;  // Within this distance behind the deepest point it is at the end of the channel.

double in_series(double a, double b) noexcept {
  return a * b / (a + b);
}

/// The needle in its tissue during one step, and the results of the step.
struct TipStep {
  NeedleBalance balance;
  double moved_mm = 0.0;  ///< Motion of the proxy.
  double front_mm = 0.0;  ///< Tip on the path in undented tissue.
  std::uint8_t punctured = kNoLayer;
  bool hit_bound = false;
};

ProxyNeedleStep in_air(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN,
                       double dt_s) noexcept {
  if (path.is_open) leave_body(path);
  ProxyNeedleStep step;
  step.axial.tip_P = X_PN.p();
  step.axial.axis_P = X_PN.R().col(2);
  step.axial.velocity_mm_per_s = (X_PN.p() - state.proxy_P).dot(step.axial.axis_P) / dt_s;
  state.proxy_P = X_PN.p();
  state.proxy_A = now.motion.to_rest(X_PN.p());
  state.tissue_n_per_mm = 0.0;
  state.wall = kNoLayer;
  state.is_on_skin = false;
  state.phase = telemetry::InsertionPhase::kOutside;
  return step;
}

/// The skin under the tip gives way: the path begins at the point that the tip held, along the needle's axis.
void open_skin(ProxyNeedleState& state, InsertionPath& path, std::uint8_t layer, InsertionStep& axial,
               const motion::PatientMotion& motion) noexcept {
  state.proxy_P = state.skin.anchor_P;
  start_channel(path, state.skin.anchor_P, axial.axis_P);
  open_path(path, layer, motion);
  path.contact_to_puncture_P = axial.tip_P - state.contact_P;
  state.needle_mm = axial.depth_mm * state.skin.way_P.dot(axial.axis_P);
  axial.punctured = layer;
  state.is_on_skin = false;
}

/// The tip on unpierced skin (physics.md V2): its spring is the coupling in series with the skin's indentation, damped
/// unless the point of the skin that it holds slides.
ProxyNeedleStep on_skin(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN,
                        const Pose& X_PN_ahead, double dt_s) noexcept {
  const HapticScene& scene = now.scene;
  SkinContact& skin = state.skin;
  follow_skin(skin, now, X_PN.p(), scene.friction.tip, dt_s);
  if (!(skin.to_device_mm > 0.0)) return in_air(state, path, now, X_PN, dt_s);
  const std::uint8_t layer = scene.tissues[scene.skin].layer;
  const double tissue_n_per_mm = layer == kNoLayer ? 1.0 : scene.layers[layer].indent_n_per_mm;
  const double k = in_series(scene.options.coupling.stiffness_n_per_mm, tissue_n_per_mm);
  const double ahead_s = scene.options.coupling.damping_time_s();
  const Vec3 ahead_P = X_PN_ahead.p() - X_PN.p() - ahead_s * skin.slides_P;
  double load_n = std::max(0.0, k * (skin.to_device_mm + skin.way_P.dot(ahead_P)));
  const double puncture_n = layer == kNoLayer ? 0.0 : scene.layers[layer].puncture_force_n;
  const double share = piercing_share(skin, now, X_PN.R().col(2));  // the force along the needle counts
  const bool gives_way = share > 0.0 && share * load_n >= puncture_n;
  if (gives_way) load_n = puncture_n / share;

  ProxyNeedleStep step;
  step.tip_force_P = -load_n * skin.way_P - k * (ahead_P - skin.way_P * skin.way_P.dot(ahead_P));
  step.axial.axis_P = X_PN.R().col(2);
  step.axial.displacement_mm = step.axial.depth_mm = load_n / tissue_n_per_mm;
  step.axial.tip_P = skin.anchor_P + step.axial.depth_mm * skin.way_P;
  step.axial.tissue = scene.skin;
  step.axial.phase = state.phase = telemetry::InsertionPhase::kLoading;
  state.proxy_P = skin.anchor_P;
  state.tissue_n_per_mm = tissue_n_per_mm;
  if (gives_way) open_skin(state, path, layer, step.axial, now.motion);
  return step;
}

/// Sets the stiffness of the tissue at the tip. If it increases, or a wall is met, the proxy shifts so that the tip
/// force stays continuous.
void set_stiffness(ProxyNeedleState& state, const NeedleDrive& drive, const Channel& channel, double tissue_n_per_mm,
                   bool meets_wall) noexcept {
  const double before = state.tissue_n_per_mm;
  state.tissue_n_per_mm = tissue_n_per_mm;
  if (!(before > 0.0) || !(meets_wall || tissue_n_per_mm > before)) return;
  const Vec3& u = channel.direction_P;
  const NeedleBalance old = balance_needle(drive, before, u.dot(state.proxy_P - channel.origin_P));
  if (old.on_tip_n > 0.0) state.proxy_P += old.on_tip_n * (1.0 / before - 1.0 / tissue_n_per_mm) * u;
}

/// The tip presses on a wall, which is punctured at its puncture force.
void press_wall(TipStep& step, ProxyNeedleState& state, Channel& channel, const HapticScene& scene) noexcept {
  if (step.balance.on_tip_n < scene.layers[state.wall].puncture_force_n) return;
  step.punctured = state.wall;
  state.wall = kNoLayer;
  step.front_mm = channel.cut_to_mm = state.wall_mm + 0.5 * Channel::kBin_mm;
}

/// Motion of the proxy along the path (physics.md B3): against the largest force of its tissue.
double motion_along(const TipStep& step, const TipLaw& law, const Vec3& u_P, double dt_s) noexcept {
  const double load_n = step.balance.on_tip_n;
  const double c = (1.0 - law.border) * law.law.viscosity_ns_per_mm;
  const double borne_n = threshold_along_n(law, load_n < 0.0 ? Vec3(-u_P) : u_P) + c * std::abs(step.moved_mm) / dt_s;
  const double way_mm = std::max(0.0, std::abs(load_n) - borne_n) / (step.balance.tip_n_per_mm + c / dt_s);
  return std::copysign(way_mm, load_n);
}

/// The tissue, or the wall, at the front of the tip.
struct Front {
  TipLaw law;
  double tissue_n_per_mm = 1.0;
  double mm = 0.0;
  bool meets_wall = false;
};
Front find_front(ProxyNeedleState& state, const Channel& channel, const PatientNow& now,
                 const LayerAhead& ahead) noexcept {
  const HapticScene& scene = now.scene;
  Front front;
  const double s_mm = channel.direction_P.dot(state.proxy_P - channel.origin_P);
  if (state.wall != kNoLayer && s_mm < state.wall_anchor_mm - kAtWall_mm) state.wall = kNoLayer;  // moved back from it
  front.meets_wall = state.wall == kNoLayer && ahead.layer != kNoLayer && s_mm >= ahead.surface_mm - kAtWall_mm;
  if (front.meets_wall) {
    state.wall = ahead.layer;
    state.wall_mm = ahead.surface_mm;
  }
  front.mm = state.wall != kNoLayer ? state.wall_mm : s_mm;
  const auto bin = static_cast<std::size_t>(bin_of(front.mm));
  const TissueAt here = front.mm > 0.0 ? TissueAt{channel.tissue[bin], channel.label[bin]} : TissueAt{};
  front.law = tip_law_now(now, now.motion.to_rest(state.proxy_P), here);
  front.law.law.viscosity_ns_per_mm *= shear_thinning(state.velocity_mm_per_s);
  if (front.mm < channel.cut_to_mm - kHole_mm) {  // in its own channel the tip cuts nothing and meets no border
    front.law.border = 0.0;
    front.law.law.resistance_n = 0.0;
  }
  front.tissue_n_per_mm =
      state.wall != kNoLayer ? scene.layers[state.wall].indent_n_per_mm : front.law.law.stiffness_n_per_mm;
  return front;
}

/// Moves the proxy along the path until it rests, meets a wall or reaches the limit of sub-steps.
TipStep move_proxy(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now,
                   const NeedleDrive& drive) noexcept {
  const HapticScene& scene = now.scene;
  Channel& channel = path.channel;
  const Vec3& u = channel.direction_P;
  const auto along = [&] { return u.dot(state.proxy_P - channel.origin_P); };
  TipStep step;
  look_ahead(channel, now, std::max(0.0, along()), kLook_mm);
  const LayerAhead ahead = next_wall(channel, channel.cut_to_mm, along() + kLook_mm);
  for (int i = 0; i < kMaxProxySteps; ++i) {
    const Front front = find_front(state, channel, now, ahead);
    step.front_mm = front.mm;
    set_stiffness(state, drive, channel, front.tissue_n_per_mm, front.meets_wall);
    if (front.meets_wall) state.wall_anchor_mm = along();
    step.balance = balance_needle(drive, front.tissue_n_per_mm, along());
    if (state.wall != kNoLayer && step.balance.on_tip_n > 0.0) {
      press_wall(step, state, channel, scene);
      return step;
    }
    double motion_mm = motion_along(step, front.law, u, drive.dt_s);
    const bool is_long = std::abs(motion_mm) > kProxyStep_mm;
    if (is_long) motion_mm = std::copysign(kProxyStep_mm, motion_mm);
    const bool reaches_wall =
        state.wall == kNoLayer && ahead.layer != kNoLayer && front.mm + motion_mm > ahead.surface_mm;
    if (reaches_wall) motion_mm = std::max(0.0, ahead.surface_mm - front.mm);
    state.proxy_P += motion_mm * u;
    step.moved_mm += motion_mm;
    step.front_mm = state.wall != kNoLayer ? front.mm : along();
    step.balance = balance_needle(drive, front.tissue_n_per_mm, along());
    if (!is_long && !reaches_wall) return step;
  }
  step.hit_bound = true;
  return step;
}

telemetry::InsertionPhase next_phase(const ProxyNeedleState& state, bool is_loading) noexcept {
  if (is_loading) return telemetry::InsertionPhase::kLoading;
  if (state.velocity_mm_per_s < -kRestSpeed_mm_per_s) return telemetry::InsertionPhase::kRetracting;
  if (state.velocity_mm_per_s > kRestSpeed_mm_per_s) return telemetry::InsertionPhase::kInserted;
  return state.phase == telemetry::InsertionPhase::kRetracting ? telemetry::InsertionPhase::kRetracting
                                                               : telemetry::InsertionPhase::kInserted;
}

/// Where the patient moves: way of the tissue at the tip along the channel in the time that the pose ahead is ahead.
double tissue_ahead_mm(const Channel& channel, const PatientNow& now, double tip_mm) noexcept {
  if (channel.nodes.count == 0) return 0.0;
  const Vec3 tissue_A = ChannelNow(channel, now.motion).rest_A(tip_mm);
  return now.scene.options.coupling.damping_time_s() * channel.direction_P.dot(now.motion.velocity(tissue_A));
}

/// The tip on its path through the body.
ProxyNeedleStep in_body(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN_ahead,
                        double dt_s) noexcept {
  const HapticScene& scene = now.scene;
  const Vec3 u = path.channel.direction_P;
  const ShaftResistance resistance = shaft_resistance(path.channel, scene, path.rest_mm);
  const NeedleDrive drive{
      scene.options.coupling,
      {resistance.dry_n, shear_thinning(state.velocity_mm_per_s) * resistance.viscous_ns_per_mm},
      u.dot(X_PN_ahead.p() - path.channel.origin_P) - tissue_ahead_mm(path.channel, now, state.along_mm),
      state.needle_mm,
      dt_s,
      path.bed_out_n,
      path.bed_out_n_per_mm};
  const Vec3 origin_P = path.channel.origin_P;
  state.proxy_P = origin_P + u.dot(state.proxy_P - origin_P) * u;  // the path also guides the tip
  const TipStep moved = move_proxy(state, path, now, drive);
  state.along_mm = u.dot(state.proxy_P - origin_P);
  const bool is_at_wall = moved.punctured != kNoLayer || state.wall != kNoLayer;
  // The load of a punctured wall is its puncture force.
  const double on_tip_n =
      moved.punctured != kNoLayer ? scene.layers[moved.punctured].puncture_force_n : moved.balance.on_tip_n;

  ProxyNeedleStep step;
  step.tip_force_P = -on_tip_n * u;
  InsertionStep& axial = step.axial;
  axial.body_axial_n = moved.balance.on_shaft_n;
  axial.bed_n = moved.balance.on_bed_n;
  axial.punctured = moved.punctured;
  axial.hit_solver_bound = moved.hit_bound;
  axial.axis_P = u;
  axial.tip_P = origin_P + moved.balance.needle_mm * u;
  axial.velocity_mm_per_s = state.velocity_mm_per_s = (moved.balance.needle_mm - state.needle_mm) / dt_s;
  state.needle_mm = moved.balance.needle_mm;
  if (is_at_wall) axial.displacement_mm = std::max(0.0, on_tip_n) / state.tissue_n_per_mm;
  axial.entered = move_tip(path, now, std::max(0.0, moved.front_mm), state.wall);
  axial.depth_mm = std::max(0.0, state.needle_mm);
  axial.tissue = path.rest_mm > 0.0 ? path.channel.tissue[static_cast<std::size_t>(bin_of(path.rest_mm))] : 0;
  axial.phase = state.phase = next_phase(state, is_at_wall);
  if (moved.front_mm < -kLeaveSkin_mm) leave_body(path);
  return step;
}

/// A tip from outside: its intersection with the skin, and an open channel that it may enter. False for one that is
/// inside without having met the skin: it left its channel sideways.
bool meet(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN) noexcept {
  const Vec3 before_P = now.motion.to_now(state.proxy_A);  // the skin may have come to the tip
  if (!(skin_distance_mm(now, X_PN.p()) < 0.0) || skin_distance_mm(now, before_P) < 0.0) return false;
  state.proxy_P = meet_skin(now, before_P, X_PN.p());
  state.skin = begin_contact(now, state.proxy_P);
  state.contact_P = state.proxy_P;
  state.is_on_skin = true;
  if (const Channel* hole = path.memory.find(state.proxy_P, X_PN.R().col(2), now.motion)) {
    path.channel = *hole;
    path.is_open = true;
    carry(path.channel, now, 0.0);
    path.rest_mm = 0.0;
    state.needle_mm = path.channel.direction_P.dot(state.proxy_P - path.channel.origin_P);
    state.is_on_skin = false;
  }
  return true;
}

}  // namespace

void carry_proxy(ProxyNeedleState& state, const Channel& channel) noexcept {
  state.proxy_P = channel.origin_P + state.along_mm * channel.direction_P;
}

void start_proxy_needle(ProxyNeedleState& state, const InsertionPath& path, const Vec3& tip_P,
                        const motion::PatientMotion& motion) noexcept {
  state = {};
  state.proxy_P = tip_P;
  state.proxy_A = motion.to_rest(tip_P);
  if (!path.is_open) return;
  state.needle_mm = state.along_mm = path.channel.direction_P.dot(tip_P - path.channel.origin_P);
  state.phase = telemetry::InsertionPhase::kInserted;
}

ProxyNeedleStep step_proxy_needle(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN,
                                  const Pose& X_PN_ahead, double dt_s) noexcept {
  if (!path.is_open && !state.is_on_skin && !meet(state, path, now, X_PN)) return in_air(state, path, now, X_PN, dt_s);
  if (!path.is_open) return on_skin(state, path, now, X_PN, X_PN_ahead, dt_s);
  const ProxyNeedleStep step = in_body(state, path, now, X_PN_ahead, dt_s);
  if (path.is_open) return step;
  state.proxy_P = X_PN.p();  // left: the next contact begins where the device's tip comes from
  state.proxy_A = now.motion.to_rest(X_PN.p());
  return step;
}

}  // namespace trocar::haptics
