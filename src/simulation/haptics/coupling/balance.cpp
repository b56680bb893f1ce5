#include "haptics/coupling/balance.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {

double AxialBalance::prepuncture_n(double s_mm) const noexcept {
  return prepuncture_force_n(displacement(s_mm), velocity(s_mm), loading);
}

double AxialBalance::friction_at(double v_tip) const noexcept {
  const double v = drift_mm_per_s == 0.0 ? v_tip : v_tip + drift_mm_per_s;  // against the tissue at the shaft
  const double speed = std::abs(v);
  const double viscous_n = is_thinning ? viscous_ns_per_mm * shear_thinning(v) * speed
                                       : viscous_ns_per_mm * std::min(speed, grows_to_mm_per_s);
  return std::copysign(std::max(0.0, viscous_n + (noise_n + dry_n) * motion_fade(v)), v);
}

AxialBalance::Resistance AxialBalance::resistance_at(double s_mm, double v) const noexcept {
  const double x_mm = displacement(s_mm);
  Resistance resistance{x_mm > 0.0 ? prepuncture_force_n(x_mm, v, loading) : 0.0, friction_at(v), 0.0, bed_at_n(s_mm)};
  if (cutting_n > 0.0 && s_mm > cut_to_mm && v > 0.0)
    resistance.cutting_n = std::max(0.0, cutting_n * motion_fade(v) - resistance.layer_n);
  return resistance;
}

double AxialBalance::recoiling_under(double load_n) const noexcept {
  if (!(recoil_mm > 0.0)) return 0.0;
  const double held_mm = below != nullptr ? std::min(recoil_mm, below->depression_mm(load_n)) : 0.0;
  return held_mm + (recoil_mm - held_mm) * kTissueRecoil_s / (kTissueRecoil_s + dt_s);
}

double AxialBalance::yielding_under(const Resistance& resistance) const noexcept {
  if (gives_again_mm > 0.0 && below != nullptr)
    return std::min(gives_again_mm, below->depression_mm(resistance.sum_n() + stick_n));
  const double under_load_mm = is_yielding ? below->depression_mm(resistance.layer_n) : 0.0;
  return std::max(under_load_mm, recoiling_under(resistance.sum_n() + stick_n));
}

double AxialBalance::coupling_under(double s_mm, double v, const Resistance& resistance) const noexcept {
  const double yields_mm = yielding_under(resistance);
  const double v_tip = v + (yields_mm - yielded_mm) / dt_s;
  return coupling.stiffness_n_per_mm * (s_device_mm - yields_mm - s_mm) +
         coupling.damping_ns_per_mm * (v_device_mm_per_s - v_tip);
}

double AxialBalance::friction_n(double s_mm) const noexcept {
  return friction_at(velocity(s_mm));
}

double AxialBalance::cutting_force_n(double s_mm) const noexcept {
  return resistance_at(s_mm, velocity(s_mm)).cutting_n;
}

double AxialBalance::yielding_mm(double s_mm) const noexcept {
  return yielding_under(resistance_at(s_mm, velocity(s_mm)));
}

double AxialBalance::recoiling_mm(double s_mm) const noexcept {
  return recoiling_under(resistance_at(s_mm, velocity(s_mm)).sum_n() + stick_n);
}

double AxialBalance::coupling_n(double s_mm) const noexcept {
  const double v = velocity(s_mm);
  return coupling_under(s_mm, v, resistance_at(s_mm, v));
}

double AxialBalance::holding_n() const noexcept {
  AxialBalance held = *this;
  const double others_n = prepuncture_n(s_previous_mm) + bed_n;
  const auto missing_n = [&](double stick) {
    held.stick_n = stick;
    return held.coupling_n(s_previous_mm) - others_n - stick;
  };
  const double without_load_n = missing_n(0.0);
  // A recoil is slow: its load of this tick counts in the next one.
  if (!(gives_again_mm > 0.0) || !(without_load_n > 0.0)) return without_load_n;
  constexpr int kHalvings = 30;
  double low = 0.0, high = without_load_n;  // the missing force falls with the load
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (missing_n(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

double AxialBalance::unbalance_n(double s_mm) const noexcept {
  const double v = velocity(s_mm);
  const Resistance resistance = resistance_at(s_mm, v);
  return resistance.sum_n() - coupling_under(s_mm, v, resistance);
}

AxialSolution solve(const AxialBalance& balance) noexcept {
  // Bracket: without resistance the needle would move to the device; resistance and damping only shorten the motion.
  double low = std::min(balance.s_previous_mm, balance.s_device_mm);
  double high = std::max(balance.s_previous_mm, balance.s_device_mm);
  double f_low = balance.unbalance_n(low);
  double f_high = balance.unbalance_n(high);
  double reach = 0.01;
  constexpr int kMaxBracket = 40;
  int steps = 0;
  for (; f_low > 0.0 && steps < kMaxBracket; ++steps, reach *= 2.0) f_low = balance.unbalance_n(low -= reach);
  for (reach = 0.01; f_high < 0.0 && steps < kMaxBracket; ++steps, reach *= 2.0)
    f_high = balance.unbalance_n(high += reach);
  if (!(f_low <= 0.0) || !(f_high >= 0.0)) return {balance.s_previous_mm, true};

  // Illinois variant of the false position: robust like bisection, nearly as fast as the secant method.
  constexpr double kForceTolerance_n = 1e-10;
  constexpr double kWidth_mm = 1e-12;
  constexpr int kMaxSteps = 100;
  int side = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    if (high - low < kWidth_mm) return {0.5 * (low + high), false};
    const double secant = (low * f_high - high * f_low) / (f_high - f_low);
    const double s = (i % 8 == 7 || !(secant > low && secant < high)) ? 0.5 * (low + high) : secant;
    const double f = balance.unbalance_n(s);
    if (std::abs(f) < kForceTolerance_n) return {s, false};
    if (f < 0.0) {
      low = s;
      f_low = f;
      if (side == -1) f_high *= 0.5;
      side = -1;
    } else {
      high = s;
      f_high = f;
      if (side == 1) f_low *= 0.5;
      side = 1;
    }
  }
  return {0.5 * (low + high), true};
}

}  // namespace trocar::haptics
