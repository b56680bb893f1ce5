#include "haptics/proxy/tip_proxy.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
namespace {

/// The part of v that exceeds `threshold`.
Vec3 beyond(const Vec3& v, double threshold) noexcept {
  const double length = v.norm();
  return length > threshold && length > 0.0 ? Vec3(v * (1.0 - threshold / length)) : Vec3::Zero();
}

}  // namespace

Vec3 residual_force(const Vec3& f, const TipLaw& tip, double resistance_n) noexcept {
  const double f_normal = f.dot(tip.normal_P);
  const Vec3 f_tangential = f - f_normal * tip.normal_P;
  // (3): into denser tissue T_N must be exceeded; out of it the proxy follows freely.
  const double normal = f_normal > 0.0 ? std::max(0.0, f_normal - tip.border * tip.law.normal_n) : f_normal;
  // (4), from the same x_p.
  const Vec3 tangential = beyond(f_tangential, tip.border * tip.law.tangential_n);
  return beyond(normal * tip.normal_P + tangential, resistance_n);  // (5)
}

TipSpring free_spring(double stiffness_n_per_mm, double damping_s, const Vec3& target_P, const Vec3& proxy_P,
                      const Vec3& moved, double dt_s) noexcept {
  TipSpring spring;
  spring.force_P = stiffness_n_per_mm * (target_P - proxy_P - damping_s / dt_s * moved);
  spring.axial_n_per_mm = spring.lateral_n_per_mm = stiffness_n_per_mm * (1.0 + damping_s / dt_s);
  spring.dt_s = dt_s;
  return spring;
}

Vec3 proxy_motion(const TipSpring& spring, const TipLaw& tip, const Vec3& moved) noexcept {
  const double c = (1.0 - tip.border) * tip.law.viscosity_ns_per_mm;
  const double resistance_n = (1.0 - tip.border) * tip.law.resistance_n + c * moved.norm() / spring.dt_s;
  const Vec3 residual = residual_force(spring.force_P, tip, resistance_n);
  // A motion by delta reduces the spring's force and increases the viscous force.
  const double axial = residual.dot(spring.u_P);
  const Vec3 lateral = residual - axial * spring.u_P;
  return axial / (spring.axial_n_per_mm + c / spring.dt_s) * spring.u_P +
         lateral / (spring.lateral_n_per_mm + c / spring.dt_s);
}

NeedleBalance balance_needle(const NeedleDrive& drive, double tissue_n_per_mm, double proxy_mm) noexcept {
  const CouplingParams& coupling = drive.coupling;
  const double push_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - drive.before_mm) -
                        tissue_n_per_mm * (drive.before_mm - proxy_mm) - drive.bed_n;
  const double slip_n = push_n - std::clamp(push_n, -drive.friction.dry_n, drive.friction.dry_n);
  const double denominator = coupling.stiffness_n_per_mm + tissue_n_per_mm + drive.bed_n_per_mm +
                             (coupling.damping_ns_per_mm + drive.friction.viscous_ns_per_mm) / drive.dt_s;
  NeedleBalance balance;
  const double way_mm = slip_n / denominator;
  balance.needle_mm = drive.before_mm + way_mm;
  balance.on_tip_n = tissue_n_per_mm * (balance.needle_mm - proxy_mm);
  balance.on_bed_n = drive.bed_n + drive.bed_n_per_mm * way_mm;
  balance.on_shaft_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - balance.needle_mm) -
                       coupling.damping_ns_per_mm * way_mm / drive.dt_s - balance.on_tip_n - balance.on_bed_n;
  const double follow = slip_n != 0.0 ? tissue_n_per_mm / denominator : 0.0;
  balance.tip_n_per_mm = tissue_n_per_mm * (1.0 - follow);
  return balance;
}

}  // namespace trocar::haptics
