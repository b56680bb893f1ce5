#include "haptics/insertion/insertion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "haptics/coupling/balance.h"

namespace trocar::haptics {
namespace {

constexpr double kContactHysteresis_mm = 0.1;
constexpr double kSpeedSmoothing_s = 0.02;

/// Needle and device on the line of this step, at its start and end.
struct LineStep {
  double s_previous_mm;
  double s_device_previous_mm;
  double s_device_mm;
};

void stop_loading(InsertionState& state) noexcept {
  state.loading = kNoLayer;
  state.is_yielding = state.is_stuck = false;
  state.pending_s = 0.0;
  state.pressed_to_mm = state.front_n = 0.0;
}

/// Where the tip of a needle in air meets the skin, or an open channel: false while it stays in air. Skin that still
/// recoils from a puncture is met that much deeper. A tip that is below it without having met it (it left its channel
/// sideways) meets it only after it has come out.
bool meet(InsertionState& state, InsertionPath& path, const PatientNow& now, const Vec3& tip_P,
          const Vec3& axis_P) noexcept {
  if (!(skin_distance_mm(now, tip_P) < -state.recoil_mm)) return false;
  constexpr double kBefore = 1.05;                              // the recoil of the last tick was deeper by less
  constexpr double kRounding_mm = 1e-6;                         // a tip that just touched the skin pressed on nothing
  const Vec3 before_P = now.motion.to_now(state.device_tip_A);  // the skin may have come to the tip
  const double before_mm = skin_distance_mm(now, before_P);
  if (before_mm < -kBefore * state.recoil_mm - kRounding_mm) return false;
  const bool is_from_outside = before_mm > 0.0;
  const Vec3 entry_P = is_from_outside ? meet_skin(now, before_P, tip_P) : nearest_skin(now, tip_P);
  Vec3 way_P = inward_normal(now, entry_P);
  if (const Channel* hole = path.memory.find(entry_P, axis_P, now.motion)) {
    path.channel = *hole;
    path.is_open = true;
    carry(path.channel, now, 0.0);
    way_P = path.channel.direction_P;
  } else {
    start_channel(path, entry_P, axis_P);
    state.skin = begin_contact(now, entry_P);
  }
  // So far needle and device coincided, above skin that may still recoil.
  state.s_device_mm = way_P.dot(before_P - path.channel.origin_P);
  state.yielded_mm = state.recoil_mm;
  state.s_mm = state.s_device_mm - state.yielded_mm;
  return true;
}

/// Projects needle and device onto the line of this step: the path after the skin puncture, before that the way from
/// the point of the skin that the tip holds to the device's tip. Empty: in air.
std::optional<LineStep> place_on_line(InsertionState& state, InsertionPath& path, const PatientNow& now,
                                      const Vec3& tip_P, const Vec3& axis_P, double dt_s) noexcept {
  if (!path.is_open && state.loading == kNoLayer && !meet(state, path, now, tip_P, axis_P)) return std::nullopt;
  const Channel& line = path.channel;
  if (path.is_open) return LineStep{state.s_mm, state.s_device_mm, line.direction_P.dot(tip_P - line.origin_P)};
  follow_skin(state.skin, now, tip_P, now.scene.friction.tip, dt_s);
  path.channel.origin_P = state.skin.anchor_P;
  path.channel.direction_P = axis_P;
  return LineStep{state.s_mm, state.s_device_mm, state.skin.to_device_mm};
}

/// The layer under load, or the next one ahead of the tip.
LayerAhead layer_in_front(InsertionState& state, InsertionPath& path, const PatientNow& now) noexcept {
  const HapticScene& scene = now.scene;
  if (state.loading != kNoLayer) return {state.loading, state.surface_mm};
  if (!path.is_open) return {scene.tissues[scene.skin].layer, 0.0};  // s is measured from the resting skin
  look_ahead(path.channel, now, std::max(state.s_mm, 0.0), kLook_mm);
  // From the resting tip on: a punctured layer may have covered the next one.
  LayerAhead ahead = next_layer(path.channel, scene, path.rest_mm, std::max(state.s_mm, 0.0) + kLook_mm);
  ahead.surface_mm = std::max(ahead.surface_mm, state.s_mm);
  return ahead;
}

/// Friction of paper A: each tissue by the shaft length in it, with its fluctuation.
void add_friction(AxialBalance& balance, const InsertionPath& path, const HapticScene& scene) noexcept {
  balance.grows_to_mm_per_s = scene.friction.grows_to_mm_per_s;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scene.tissue_count); ++i) {
    if (path.inserted_mm[i] <= 0.0) continue;
    balance.viscous_ns_per_mm +=
        scene.tissues[i].viscosity_ns_per_mm * contact_area_cm2(scene.needle.radius_mm, path.inserted_mm[i]);
    balance.noise_n +=
        scene.tissues[i].noise_n * friction_noise(scene.options.seed, static_cast<std::uint32_t>(i), path.travel_mm);
  }
}

/// Force that the tip needs to advance through the tissue in front of it (C1, or the tip proxy's threshold), also while
/// it presses on the layer behind that tissue.
void set_front(InsertionState& state, const InsertionPath& path, const HapticScene& scene,
               const ProxyShare* share) noexcept {
  if (!path.is_open) {
    state.front_n = 0.0;
    return;
  }
  if (state.loading != kNoLayer) return;
  state.is_front_proxy = share != nullptr && share->tip_n > 0.0;
  const auto tip_bin = static_cast<std::size_t>(bin_of(path.rest_mm));
  state.front_n = state.is_front_proxy ? share->tip_n : scene.tissues[path.channel.tissue[tip_bin]].cutting_n;
}

AxialBalance make_balance(const InsertionState& state, const InsertionPath& path, const PatientNow& now,
                          const LineStep& line, double dt_s, const LayerAhead& ahead,
                          const ProxyShare* share) noexcept {
  const HapticScene& scene = now.scene;
  AxialBalance balance;
  balance.drift_mm_per_s = tissue_drift_mm_per_s(path.channel, now, path.rest_mm);
  balance.s_previous_mm = line.s_previous_mm;
  balance.s_device_mm = line.s_device_mm;
  balance.v_device_mm_per_s = (line.s_device_mm - line.s_device_previous_mm) / dt_s;
  balance.dt_s = dt_s;
  balance.coupling = scene.options.coupling;
  balance.yielded_mm = state.yielded_mm;
  balance.recoil_mm = state.recoil_mm;
  balance.gives_again_mm = state.gives_again_mm;
  if (ahead.layer != kNoLayer) {
    balance.loading = scene.layers[ahead.layer].loading;
    balance.surface_mm = ahead.surface_mm;
  }
  balance.bed_n = path.bed_out_n;
  balance.bed_n_per_mm = path.bed_out_n_per_mm;
  if (state.below.cells > 0) balance.below = &state.below;
  balance.is_yielding = state.is_yielding && balance.below != nullptr;
  balance.cutting_n = state.front_n;
  balance.cut_to_mm = std::max(path.channel.cut_to_mm, state.pressed_to_mm);
  if (share == nullptr) {
    add_friction(balance, path, scene);
    return balance;
  }
  balance.viscous_ns_per_mm = share->shaft.viscous_ns_per_mm;
  balance.dry_n = share->shaft.dry_n;
  balance.is_thinning = true;
  if (path.is_open && state.loading == kNoLayer) balance.viscous_ns_per_mm += share->tip_viscous_ns_per_mm;
  return balance;
}

double holding_force_n(const InsertionPath& path, const HapticScene& scene, const AxialBalance& balance) noexcept {
  if (scene.options.force_model == ForceModel::kCombined) return balance.dry_n;
  double force = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scene.tissue_count); ++i)
    force += scene.tissues[i].stick_n_per_mm * std::max(0.0, path.inserted_mm[i]);
  return force;
}

/// Karnopp: a needle at rest stays at rest while the forces on it are below the holding force.
bool is_held(const InsertionState& state, const InsertionPath& path, const HapticScene& scene,
             const AxialBalance& balance) noexcept {
  if (!scene.options.has_stick || !path.is_open) return false;
  const bool at_rest = state.is_stuck || (std::abs(state.velocity_mm_per_s) <= kRestSpeed_mm_per_s &&
                                          state.device_speed_mm_per_s <= kRestSpeed_mm_per_s);
  if (!at_rest) return false;
  const double s = balance.s_previous_mm;
  const double push = balance.holding_n();
  const double holding = holding_force_n(path, scene, balance);
  // Uncut tissue holds until it is cut, except the share that the layer behind it bears.
  const double uncut = s >= balance.cut_to_mm ? std::max(0.0, balance.cutting_n - balance.prepuncture_n(s)) : 0.0;
  return push <= holding + uncut && push >= -holding;
}

/// The holding force of a needle at rest also loads the tissue that recoils.
void hold(AxialBalance& balance) noexcept {
  balance.stick_n = balance.holding_n();
}

/// Fraction of the step at which the layer reaches its puncture force.
struct Puncture {
  double fraction;
  AxialBalance balance;
  double s_mm;
};
Puncture find_puncture(const AxialBalance& whole, const LineStep& line, double v_device_before_mm_per_s,
                       double puncture_force_n) noexcept {
  constexpr int kMaxSteps = 40;
  constexpr double kTolerance = 1e-4;
  double low = 1e-3;
  double high = 1.0;
  Puncture puncture{1.0, whole, 0.0};
  for (int i = 0; i < kMaxSteps; ++i) {
    puncture.fraction = 0.5 * (low + high);
    puncture.balance.dt_s = whole.dt_s * puncture.fraction;
    puncture.balance.s_device_mm = std::lerp(line.s_device_previous_mm, line.s_device_mm, puncture.fraction);
    // The device's speed changes linearly over the tick: the force is continuous between ticks.
    puncture.balance.v_device_mm_per_s =
        std::lerp(v_device_before_mm_per_s, whole.v_device_mm_per_s, puncture.fraction);
    puncture.s_mm = solve(puncture.balance).s_mm;
    const double force = puncture.balance.prepuncture_n(puncture.s_mm);
    if (std::abs(force - puncture_force_n) < kTolerance * puncture_force_n) break;
    (force < puncture_force_n ? low : high) = puncture.fraction;
  }
  return puncture;
}

telemetry::InsertionPhase next_phase(const InsertionState& state, const InsertionPath& path) noexcept {
  if (state.loading != kNoLayer) return telemetry::InsertionPhase::kLoading;
  if (!path.is_open) return telemetry::InsertionPhase::kOutside;
  if (state.velocity_mm_per_s < -kRestSpeed_mm_per_s) return telemetry::InsertionPhase::kRetracting;
  if (state.velocity_mm_per_s > kRestSpeed_mm_per_s) return telemetry::InsertionPhase::kInserted;
  return state.phase == telemetry::InsertionPhase::kRetracting ? telemetry::InsertionPhase::kRetracting
                                                               : telemetry::InsertionPhase::kInserted;
}

SoftColumn column_below(const PatientNow& now, const LayerLaw& law, const Vec3& surface_P,
                        const Vec3& inward_P) noexcept {
  return soft_column(now, surface_P, inward_P, now.scene.needle.radius_mm + law.load_spread_mm, law.pressed_young_kpa);
}

/// The tip begins to press on a layer. Tissue that still recoils from the puncture before stays the tissue below.
void begin_loading(InsertionState& state, const InsertionPath& path, const PatientNow& now,
                   const LayerAhead& layer) noexcept {
  constexpr double kRecoiled_mm = 0.05;
  const LayerLaw& law = now.scene.layers[layer.layer];
  state.is_yielding = law.load_spread_mm > 0.0;
  if (!state.is_yielding || state.recoil_mm > kRecoiled_mm) return;
  const Channel& line = path.channel;
  const Vec3 inward_P = path.is_open ? line.direction_P : state.skin.way_P;
  state.below = column_below(now, law, line.origin_P + layer.surface_mm * inward_P, inward_P);
}

/// Contact with hysteresis: starts at the resting surface, ends slightly above it.
void update_contact(InsertionState& state, const InsertionPath& path, const PatientNow& now,
                    const LayerAhead& ahead) noexcept {
  if (ahead.layer == kNoLayer) return;
  if (state.s_mm > ahead.surface_mm) {
    if (!path.is_open && state.loading == kNoLayer) state.contact_P = path.channel.origin_P;
    if (state.loading == kNoLayer) begin_loading(state, path, now, ahead);
    state.loading = ahead.layer;
    state.surface_mm = ahead.surface_mm;
    if (path.is_open) state.pressed_to_mm = std::max(state.pressed_to_mm, state.s_mm);
  } else if (state.s_mm < ahead.surface_mm - kContactHysteresis_mm) {
    state.loading = kNoLayer;
  }
}

/// The place on the skin contact's way, seen along the path that opens: the needle's axis.
void turn_to_path(InsertionState& state, const InsertionPath& path) noexcept {
  const double along = state.skin.way_P.dot(path.channel.direction_P);
  for (double* value : {&state.s_mm, &state.s_device_mm, &state.yielded_mm, &state.recoil_mm, &state.velocity_mm_per_s,
                        &state.device_velocity_mm_per_s})
    *value *= along;
}

/// Punctures the layer under load; for the skin this opens the path.
void give_way(InsertionState& state, InsertionPath& path, std::uint8_t layer,
              const motion::PatientMotion& motion) noexcept {
  state.loading = kNoLayer;
  state.is_yielding = false;
  if (path.is_open) {
    path.channel.pierce(layer);
    return;
  }
  path.contact_to_puncture_P = path.channel.origin_P + state.s_mm * state.skin.way_P - state.contact_P;
  turn_to_path(state, path);
  open_path(path, layer, motion);
}

/// The virtual needle is at the device; skin that was pierced before recoils freely.
InsertionStep step_in_air(InsertionState& state, InsertionPath& path, const PatientNow& now, const Vec3& tip_P,
                          const Vec3& axis_P, double dt_s) noexcept {
  leave_body(path);
  stop_loading(state);
  state.recoil_mm *= kTissueRecoil_s / (kTissueRecoil_s + dt_s);
  state.gives_again_mm = 0.0;
  state.yielded_mm = state.recoil_mm;
  InsertionStep step;
  step.tip_P = tip_P;
  step.axis_P = axis_P;
  step.velocity_mm_per_s = (tip_P - state.device_tip_P).dot(axis_P) / dt_s;
  state.velocity_mm_per_s = state.device_velocity_mm_per_s = step.velocity_mm_per_s;
  state.device_tip_P = tip_P;
  state.device_tip_A = now.motion.to_rest(tip_P);
  state.phase = telemetry::InsertionPhase::kOutside;
  return step;
}

/// Values of the laws at the end of the step, as recorded.
void record_forces(const InsertionState& state, const AxialBalance& balance, double s_mm, const ProxyShare* share,
                   InsertionStep& step) noexcept {
  const bool is_stuck = state.is_stuck;
  step.velocity_mm_per_s = is_stuck ? 0.0 : balance.velocity(s_mm);
  step.displacement_mm = balance.displacement(s_mm);
  step.prepuncture_n = balance.prepuncture_n(s_mm);
  step.bed_n = balance.bed_at_n(s_mm);
  if (is_stuck) {
    step.stick_n = balance.coupling_n(s_mm) - step.prepuncture_n - step.bed_n;
    return;
  }
  const double friction_n = balance.friction_n(s_mm);
  (share != nullptr ? step.body_axial_n : step.friction_n) = friction_n;
  // At the border of uncut tissue F_c begins with a step: the tissue carries what the balance needs of it.
  const double tip_n = balance.cutting_force_n(s_mm);
  const double missing_n = -balance.unbalance_n(s_mm);
  constexpr double kBalanced_n = 1e-6;
  const double carried_n =
      std::abs(missing_n) < kBalanced_n ? tip_n : std::clamp(tip_n + missing_n, 0.0, balance.cutting_n);
  (state.is_front_proxy ? step.tip_proxy_n : step.cutting_n) = carried_n;
}

std::uint8_t tissue_at_tip(const InsertionState& state, const InsertionPath& path, const HapticScene& scene) noexcept {
  if (!path.is_open) return state.loading != kNoLayer ? scene.skin : std::uint8_t{0};
  return path.rest_mm > 0.0 ? path.channel.tissue[static_cast<std::size_t>(bin_of(path.rest_mm))] : std::uint8_t{0};
}

/// Balance over the step, divided at a puncture. Returns s of the virtual needle.
double solve_step(InsertionState& state, const PatientNow& now, const LineStep& line, const LayerAhead& ahead,
                  AxialBalance& balance, InsertionStep& step) noexcept {
  state.pending_s = 0.0;
  if (state.is_stuck) return line.s_previous_mm;
  const AxialSolution solution = solve(balance);
  step.hit_solver_bound = solution.hit_bound;
  if (ahead.layer == kNoLayer) return solution.s_mm;
  double puncture_force_n = now.scene.layers[ahead.layer].puncture_force_n;
  if (step.is_on_skin) {  // along the needle
    const double share = piercing_share(state.skin, now, step.axis_P);
    if (!(share > 0.0)) return solution.s_mm;
    puncture_force_n /= share;
  }
  if (balance.prepuncture_n(solution.s_mm) < puncture_force_n) return solution.s_mm;
  const Puncture puncture = find_puncture(balance, line, state.device_velocity_mm_per_s, puncture_force_n);
  state.pending_s = (1.0 - puncture.fraction) * balance.dt_s;
  balance = puncture.balance;
  step.punctured = ahead.layer;
  return puncture.s_mm;
}

}  // namespace

void start_insertion(InsertionState& state, const InsertionPath& path, const PatientNow& now, const Vec3& device_tip_P,
                     double pressed_mm) noexcept {
  state = {};
  state.device_tip_P = device_tip_P;
  state.device_tip_A = now.motion.to_rest(device_tip_P);
  if (!path.is_open) return;
  const Channel& line = path.channel;
  state.s_mm = state.s_device_mm = line.direction_P.dot(device_tip_P - line.origin_P);
  state.phase = telemetry::InsertionPhase::kInserted;
  const HapticScene& scene = now.scene;
  const std::uint8_t skin = scene.tissues[scene.skin].layer;
  if (!(pressed_mm > 0.0) || skin == kNoLayer || !(scene.layers[skin].load_spread_mm > 0.0)) return;
  state.below = column_below(now, scene.layers[skin], line.origin_P, line.direction_P);
  state.gives_again_mm = pressed_mm;
}

InsertionStep step_insertion(InsertionState& state, InsertionPath& path, const PatientNow& now,
                             const Vec3& device_tip_P, const Vec3& device_axis_P, double dt_s,
                             const ProxyShare* share) noexcept {
  const HapticScene& scene = now.scene;
  const auto line = place_on_line(state, path, now, device_tip_P, device_axis_P, dt_s);
  if (!line) return step_in_air(state, path, now, device_tip_P, device_axis_P, dt_s);

  // Balance of the virtual needle over the tick and the remaining time of the last puncture.
  const LayerAhead ahead = layer_in_front(state, path, now);
  set_front(state, path, scene, share);
  AxialBalance balance = make_balance(state, path, now, *line, dt_s + state.pending_s, ahead, share);
  const double smoothing = dt_s / (dt_s + kSpeedSmoothing_s);
  state.device_speed_mm_per_s += smoothing * (std::abs(balance.v_device_mm_per_s) - state.device_speed_mm_per_s);
  state.is_stuck = is_held(state, path, scene, balance);
  if (state.is_stuck) hold(balance);
  InsertionStep step;
  step.is_on_skin = !path.is_open;
  step.axis_P = path.channel.direction_P;
  const double s_mm = solve_step(state, now, *line, ahead, balance, step);
  record_forces(state, balance, s_mm, share, step);

  // The tip stays at the resting surface of the indented layer until its puncture.
  state.s_mm = s_mm;
  state.s_device_mm = balance.s_device_mm;
  state.velocity_mm_per_s = step.velocity_mm_per_s;
  state.device_velocity_mm_per_s = balance.v_device_mm_per_s;
  state.device_tip_P = device_tip_P;
  state.device_tip_A = now.motion.to_rest(device_tip_P);
  state.yielded_mm = balance.yielding_mm(s_mm);
  state.recoil_mm = step.punctured != kNoLayer ? state.yielded_mm : balance.recoiling_mm(s_mm);
  if (state.gives_again_mm > 0.0 && (step.punctured != kNoLayer || state.yielded_mm >= state.gives_again_mm)) {
    state.recoil_mm = state.yielded_mm;  // as pressed in as it was
    state.gives_again_mm = 0.0;
  }
  update_contact(state, path, now, ahead);
  if (path.is_open) {
    const double rest_mm = state.loading != kNoLayer ? std::min(s_mm, state.surface_mm) : s_mm;
    step.entered = move_tip(path, now, std::max(0.0, rest_mm), state.loading);
  }
  state.phase = next_phase(state, path);

  step.phase = state.phase;
  step.tissue = tissue_at_tip(state, path, scene);
  step.tip_P = path.channel.origin_P + s_mm * (step.is_on_skin ? state.skin.way_P : step.axis_P);
  step.depth_mm = path.is_open || state.loading != kNoLayer ? std::max(0.0, s_mm) : 0.0;
  if (step.punctured != kNoLayer) give_way(state, path, step.punctured, now.motion);
  if (path.is_open && s_mm < -kLeaveSkin_mm) {
    leave_body(path);
    stop_loading(state);
  }
  return step;
}

}  // namespace trocar::haptics
