#include "haptics/tip_proxy.h"

#include <algorithm>
#include <cmath>

namespace trocar {
namespace {

/// The part of v that is longer than `threshold`.
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

ProxyForce proxy_force(const ProxySpring& spring, const AxialFriction& friction, const Vec3& target_P,
                       const Vec3& proxy_P, const Vec3& moved) noexcept {
  const Vec3 stretch = target_P - proxy_P - spring.damping_s / spring.dt_s * moved;
  const double axial = stretch.dot(spring.u_P);
  const double viscous_n = friction.viscous_ns_per_mm * moved.dot(spring.u_P) / spring.dt_s;
  ProxyForce force;
  force.on_shaft_n =
      viscous_n + std::clamp(spring.coupling_n_per_mm * axial - viscous_n, -friction.dry_n, friction.dry_n);
  const double tip_stretch = axial - force.on_shaft_n / spring.coupling_n_per_mm;
  force.on_tip_P =
      spring.axial_n_per_mm * tip_stretch * spring.u_P + spring.lateral_n_per_mm * (stretch - axial * spring.u_P);
  return force;
}

Vec3 proxy_motion(const ProxySpring& spring, const AxialFriction& friction, const TipLaw& tip, const Vec3& target_P,
                  const Vec3& proxy_P, const Vec3& moved) noexcept {
  const ProxyForce force = proxy_force(spring, friction, target_P, proxy_P, moved);
  const double c = (1.0 - tip.border) * tip.law.viscosity_ns_per_mm;
  const double resistance_n = (1.0 - tip.border) * tip.law.resistance_n + c * moved.norm() / spring.dt_s;
  const Vec3 residual = residual_force(force.on_tip_P, tip, resistance_n);
  // Moving on by delta lowers the spring's force and raises what is viscous.
  const double follow = 1.0 + spring.damping_s / spring.dt_s;
  const double axial = residual.dot(spring.u_P);
  const Vec3 lateral = residual - axial * spring.u_P;
  const double shaft = spring.axial_n_per_mm / spring.coupling_n_per_mm * friction.viscous_ns_per_mm;
  const double axial_n_per_mm = spring.axial_n_per_mm * follow + (c + shaft) / spring.dt_s;
  const double lateral_n_per_mm = spring.lateral_n_per_mm * follow + c / spring.dt_s;
  return axial / axial_n_per_mm * spring.u_P + lateral / lateral_n_per_mm;
}

}  // namespace trocar
