#include "haptics/insertion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "haptics/balance.h"
#include "volume/sampling.h"

namespace trocar {
namespace {

constexpr double kLook_mm = 10.0;  // Past the tip and the device: more than a tick can jump.
constexpr double kContactHysteresis_mm = 0.1;
constexpr double kLeaveSkin_mm = 0.5;  // The insertion ends when the tip is this far out.
constexpr double kSpeedSmoothing_s = 0.02;

/// Distance (mm) along the axis from the tip to the resting skin; negative when the tip is below it. Nothing when the
/// skin is not near, or the axis only grazes it.
std::optional<double> distance_to_skin_along(const HapticScene& scene, const Vec3& tip_P, const Vec3& axis_P) noexcept {
  const FloatGrid& distance = scene.patient->skin_distance_mm;
  constexpr double kReach_mm = 30.0;
  constexpr double kGrazing = 0.17;  // cosine of 80 degrees
  constexpr int kMaxSteps = 12;
  double t = 0.0;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Vec3 here_P = tip_P + t * axis_P;
    const double d = sample_linear(distance, here_P);
    if (!(std::abs(d) < kReach_mm)) return std::nullopt;
    if (std::abs(d) < 1e-6) return t;
    const double slope = gradient_per_mm(distance, here_P).dot(axis_P);
    if (slope > -kGrazing) return std::nullopt;
    t -= d / slope;
    if (std::abs(t) > kReach_mm) return std::nullopt;
  }
  return t;
}

/// Needle and device on the line of this step, before and now.
struct LineStep {
  double s_previous_mm;
  double s_device_previous_mm;
  double s_device_mm;
};

void start_channel(InsertionState& state, const Vec3& origin_P, const Vec3& direction_P) noexcept {
  state.channel.is_used = true;
  state.channel.origin_P = origin_P;
  state.channel.direction_P = direction_P;
  state.channel.pierced = 0;
  state.channel.cut_to_mm = 0.0;
  state.channel.known_bins = 0;
}

void leave_body(InsertionState& state) noexcept {
  if (state.has_path) state.memory.remember(state.channel);
  state.has_path = false;
  state.contact_to_puncture_P = Vec3::Zero();
  state.loading = kNoLayer;
  state.is_stuck = false;
  state.pending_s = 0.0;
  state.rest_mm = 0.0;
  state.label = 0;
  state.inserted_mm.fill(0.0);
}

/// Places needle and device on the line of this step: the path once the skin is open, before that the needle's own axis
/// from where it meets the skin. Nothing: no skin ahead.
std::optional<LineStep> place_on_line(InsertionState& state, const HapticScene& scene, const Vec3& tip_P,
                                      const Vec3& axis_P) noexcept {
  if (!state.has_path) {
    const auto to_skin = distance_to_skin_along(scene, tip_P, axis_P);
    if (!to_skin) return std::nullopt;
    const Vec3 entry_P = tip_P + *to_skin * axis_P;
    if (const Channel* hole =
            state.loading == kNoLayer && *to_skin < 0.0 ? state.memory.find(entry_P, axis_P) : nullptr) {
      state.channel = *hole;
      state.has_path = true;
    } else if (state.loading == kNoLayer) {
      start_channel(state, entry_P, axis_P);
    } else {  // sliding and turning on the skin
      state.channel.origin_P = entry_P;
      state.channel.direction_P = axis_P;
    }
    if (state.loading == kNoLayer) {  // nothing touched yet: needle and device were in one place
      state.s_mm = state.s_device_mm = state.channel.direction_P.dot(state.device_tip_P - state.channel.origin_P);
    }
  }
  const Channel& line = state.channel;
  return LineStep{state.s_mm, state.s_device_mm, line.direction_P.dot(tip_P - line.origin_P)};
}

/// The layer under load, or the one that the tip will meet next.
LayerAhead layer_in_front(InsertionState& state, const HapticScene& scene) noexcept {
  if (state.loading != kNoLayer) return {state.loading, state.surface_mm};
  if (!state.has_path) return {scene.tissues[scene.skin].layer, 0.0};  // s is counted from the resting skin
  look_ahead(state.channel, scene, std::max(state.s_mm, 0.0), kLook_mm);
  // From the resting tip on: a layer that gave way may have lain over the next one.
  LayerAhead ahead = next_layer(state.channel, scene, state.rest_mm, std::max(state.s_mm, 0.0) + kLook_mm);
  ahead.surface_mm = std::max(ahead.surface_mm, state.s_mm);
  return ahead;
}

AxialBalance make_balance(const InsertionState& state, const HapticScene& scene, const LineStep& line, double dt_s,
                          const LayerAhead& ahead) noexcept {
  AxialBalance balance;
  balance.s_previous_mm = line.s_previous_mm;
  balance.s_device_mm = line.s_device_mm;
  balance.v_device_mm_per_s = (line.s_device_mm - line.s_device_previous_mm) / dt_s;
  balance.dt_s = dt_s;
  balance.coupling = scene.options.coupling;
  if (ahead.layer != kNoLayer) {
    balance.loading = scene.layers[ahead.layer].loading;
    balance.surface_mm = ahead.surface_mm;
  }
  const double fade = motion_fade(state.velocity_mm_per_s);
  for (std::size_t i = 0; i < static_cast<std::size_t>(scene.tissue_count); ++i) {
    if (state.inserted_mm[i] <= 0.0) continue;
    balance.viscous_ns_per_mm +=
        scene.tissues[i].viscosity_ns_per_mm * contact_area_cm2(scene.needle.radius_mm, state.inserted_mm[i]);
    balance.noise_n += fade * scene.tissues[i].noise_n *
                       friction_noise(scene.options.seed, static_cast<std::uint32_t>(i), state.travel_mm);
  }
  if (state.has_path && state.loading == kNoLayer) {
    const auto tip_bin = static_cast<std::size_t>(bin_of(state.rest_mm));
    balance.cutting_n = scene.tissues[state.channel.tissue[tip_bin]].cutting_n;
    balance.cut_to_mm = state.channel.cut_to_mm;
  }
  return balance;
}

double holding_force_n(const InsertionState& state, const HapticScene& scene) noexcept {
  double force = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scene.tissue_count); ++i)
    force += scene.tissues[i].stick_n_per_mm * std::max(0.0, state.inserted_mm[i]);
  return force;
}

/// Karnopp: a needle at rest stays there while the forces on it are below the holding force.
bool is_held(const InsertionState& state, const HapticScene& scene, const AxialBalance& balance) noexcept {
  if (!scene.options.has_stick || !state.has_path) return false;
  const bool at_rest = state.is_stuck || (std::abs(state.velocity_mm_per_s) <= kRestSpeed_mm_per_s &&
                                          state.device_speed_mm_per_s <= kRestSpeed_mm_per_s);
  if (!at_rest) return false;
  const double s = balance.s_previous_mm;
  const double push = balance.coupling_n(s) - balance.prepuncture_n(s);
  const double holding = holding_force_n(state, scene);
  const double uncut = s >= balance.cut_to_mm ? balance.cutting_n : 0.0;  // fresh tissue holds until it is cut
  return push <= holding + uncut && push >= -holding;
}

/// The part of the step after which the layer carries its puncture force.
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
    // The device's speed changes over the tick, not at its start: the force is continuous between ticks.
    puncture.balance.v_device_mm_per_s =
        std::lerp(v_device_before_mm_per_s, whole.v_device_mm_per_s, puncture.fraction);
    puncture.s_mm = solve(puncture.balance).s_mm;
    const double force = puncture.balance.prepuncture_n(puncture.s_mm);
    if (std::abs(force - puncture_force_n) < kTolerance * puncture_force_n) break;
    (force < puncture_force_n ? low : high) = puncture.fraction;
  }
  return puncture;
}

/// Moves the tip in the resting anatomy: shaft lengths, labels entered, depth cut.
void move_tip(InsertionState& state, double rest_mm, InsertionStep& step) noexcept {
  const double low = std::min(state.rest_mm, rest_mm);
  const double high = std::max(state.rest_mm, rest_mm);
  const bool is_forward = rest_mm > state.rest_mm;
  std::size_t entered = 0;
  const int end = bin_of(high);
  for (int bin = bin_of(low); bin <= end && high > low; ++bin) {
    const auto index = static_cast<std::size_t>(bin);
    const double length = std::min(high, (bin + 1) * Channel::kBin_mm) - std::max(low, bin * Channel::kBin_mm);
    if (length > 0.0) {
      double& inserted = state.inserted_mm[state.channel.tissue[index]];
      inserted = std::max(0.0, is_forward ? inserted + length : inserted - length);
    }
    const std::uint8_t label = state.channel.label[index];
    if (is_forward && label != state.label) {
      state.label = label;
      if (label != 0 && entered < step.entered.size())
        step.entered[entered++] = label;
      else if (label != 0)
        step.dropped_events = true;
    }
  }
  if (!is_forward) state.label = state.channel.label[static_cast<std::size_t>(bin_of(rest_mm))];
  state.travel_mm += high - low;
  state.rest_mm = rest_mm;
  state.channel.cut_to_mm = std::max(state.channel.cut_to_mm, rest_mm);
}

InsertionPhase next_phase(const InsertionState& state) noexcept {
  if (state.loading != kNoLayer) return InsertionPhase::kLoading;
  if (!state.has_path) return InsertionPhase::kOutside;
  if (state.velocity_mm_per_s < -kRestSpeed_mm_per_s) return InsertionPhase::kRetracting;
  if (state.velocity_mm_per_s > kRestSpeed_mm_per_s) return InsertionPhase::kInserted;
  return state.phase == InsertionPhase::kRetracting ? InsertionPhase::kRetracting : InsertionPhase::kInserted;
}

/// Contact with hysteresis: begins at the resting surface, ends a little above it.
void update_contact(InsertionState& state, const LayerAhead& ahead) noexcept {
  if (ahead.layer == kNoLayer) return;
  if (state.s_mm > ahead.surface_mm) {
    if (!state.has_path && state.loading == kNoLayer) state.contact_P = state.channel.origin_P;
    state.loading = ahead.layer;
    state.surface_mm = ahead.surface_mm;
  } else if (state.s_mm < ahead.surface_mm - kContactHysteresis_mm) {
    state.loading = kNoLayer;
  }
}

/// The layer under load gives way; behind the skin this opens the path.
void give_way(InsertionState& state, std::uint8_t layer) noexcept {
  state.loading = kNoLayer;
  state.channel.pierce(layer);
  if (state.has_path) return;
  state.has_path = true;
  state.contact_to_puncture_P = state.channel.origin_P + state.s_mm * state.channel.direction_P - state.contact_P;
  state.rest_mm = 0.0;
  state.channel.known_bins = 0;  // the line may have turned while the skin was loaded
}

/// No skin ahead: the virtual needle is where the device is.
InsertionStep step_in_air(InsertionState& state, const Vec3& tip_P, const Vec3& axis_P, double dt_s) noexcept {
  leave_body(state);
  InsertionStep step;
  step.tip_P = tip_P;
  step.axis_P = axis_P;
  step.velocity_mm_per_s = (tip_P - state.device_tip_P).dot(axis_P) / dt_s;
  state.velocity_mm_per_s = state.device_velocity_mm_per_s = step.velocity_mm_per_s;
  state.device_tip_P = tip_P;
  state.phase = InsertionPhase::kOutside;
  return step;
}

/// The values of the laws at the end of the step, as recorded.
void record_forces(const AxialBalance& balance, double s_mm, bool is_stuck, InsertionStep& step) noexcept {
  step.velocity_mm_per_s = is_stuck ? 0.0 : balance.velocity(s_mm);
  step.displacement_mm = balance.displacement(s_mm);
  step.prepuncture_n = balance.prepuncture_n(s_mm);
  if (is_stuck) {
    step.stick_n = balance.coupling_n(s_mm) - step.prepuncture_n;
    return;
  }
  step.friction_n = balance.friction_n(s_mm);
  step.cutting_n = balance.cutting_force_n(s_mm);
}

std::uint8_t tissue_at_tip(const InsertionState& state, const HapticScene& scene) noexcept {
  if (!state.has_path) return state.loading != kNoLayer ? scene.skin : std::uint8_t{0};
  return state.rest_mm > 0.0 ? state.channel.tissue[static_cast<std::size_t>(bin_of(state.rest_mm))] : std::uint8_t{0};
}

}  // namespace

InsertionStep step_insertion(InsertionState& state, const HapticScene& scene, const Vec3& device_tip_P,
                             const Vec3& device_axis_P, double dt_s) noexcept {
  if (!state.is_started) state.device_tip_P = device_tip_P;
  state.is_started = true;
  const auto line = place_on_line(state, scene, device_tip_P, device_axis_P);
  if (!line) return step_in_air(state, device_tip_P, device_axis_P, dt_s);

  // Balance of the virtual needle, over the tick and what the last puncture left of the one before.
  const LayerAhead ahead = layer_in_front(state, scene);
  AxialBalance balance = make_balance(state, scene, *line, dt_s + state.pending_s, ahead);
  const double smoothing = dt_s / (dt_s + kSpeedSmoothing_s);
  state.device_speed_mm_per_s += smoothing * (std::abs(balance.v_device_mm_per_s) - state.device_speed_mm_per_s);
  state.is_stuck = is_held(state, scene, balance);

  InsertionStep step;
  double s_mm = line->s_previous_mm;
  state.pending_s = 0.0;
  if (!state.is_stuck) {
    const AxialSolution solution = solve(balance);
    s_mm = solution.s_mm;
    step.hit_solver_bound = solution.hit_bound;
    if (ahead.layer != kNoLayer && balance.prepuncture_n(s_mm) >= scene.layers[ahead.layer].puncture_force_n) {
      const Puncture puncture =
          find_puncture(balance, *line, state.device_velocity_mm_per_s, scene.layers[ahead.layer].puncture_force_n);
      state.pending_s = (1.0 - puncture.fraction) * balance.dt_s;
      balance = puncture.balance;
      s_mm = puncture.s_mm;
      step.punctured = ahead.layer;
    }
  }
  record_forces(balance, s_mm, state.is_stuck, step);

  // The tip stays at the resting surface of the layer that it indents until that gives way.
  state.s_mm = s_mm;
  state.s_device_mm = balance.s_device_mm;
  state.velocity_mm_per_s = step.velocity_mm_per_s;
  state.device_velocity_mm_per_s = balance.v_device_mm_per_s;
  state.device_tip_P = device_tip_P;
  update_contact(state, ahead);
  if (state.has_path)
    move_tip(state, std::max(0.0, state.loading != kNoLayer ? std::min(s_mm, state.surface_mm) : s_mm), step);
  state.phase = next_phase(state);

  step.phase = state.phase;
  step.tissue = tissue_at_tip(state, scene);
  step.axis_P = state.channel.direction_P;
  step.tip_P = state.channel.origin_P + s_mm * step.axis_P;
  step.depth_mm = state.has_path || state.loading != kNoLayer ? std::max(0.0, s_mm) : 0.0;
  if (step.punctured != kNoLayer) give_way(state, step.punctured);
  if (state.has_path && s_mm < -kLeaveSkin_mm) leave_body(state);
  return step;
}

}  // namespace trocar
