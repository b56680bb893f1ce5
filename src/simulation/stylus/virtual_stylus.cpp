#include "stylus/virtual_stylus.h"

#include <Eigen/Cholesky>

namespace trocar::stylus {
namespace {

constexpr double kMmPerM = 1000.0;

/// Velocities (v of S, w), the corresponding forces and torques, and matrices between the two.
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using PointVelocity = Eigen::Matrix<double, 3, 6>;

Vec6 stacked(const Vec3& upper, const Vec3& lower) noexcept {
  Vec6 both;
  both << upper, lower;
  return both;
}

Mat6 diagonal(double linear, double turning) noexcept {
  return stacked(Vec3::Constant(linear), Vec3::Constant(turning)).asDiagonal();
}

/// Velocity of the point S + r of a body: v + w x r.
PointVelocity velocity_at(const Vec3& r) noexcept {
  PointVelocity J;
  J << 1, 0, 0, 0, r.z(), -r.y(),  //
      0, 1, 0, -r.z(), 0, r.x(),   //
      0, 0, 1, r.y(), -r.x(), 0;
  return J;
}

/// The stylus and the hand as one body for a tick: A x = b, x the mean velocities. Trapezoidal rule: the springs act as
/// at the middle of the tick, M (x_end - x_start) = dt (push - B x - K (dt/2) x).
struct MovingBody {
  Mat6 A;
  Vec6 b;
};

MovingBody moving_body(const VirtualStylusState& state, const VirtualStylusParams& params, const StylusHold& hold,
                       const Wrench& wrench_P, const Vec3& gravity_P, double dt_s) noexcept {
  const double half_s = 0.5 * dt_s;
  const Vec3 z_P = state.X_PS.R().col(2);
  const Vec3 r_SH = hold.point_mm * z_P;
  const PointVelocity J = velocity_at(r_SH);
  const Mat6 at_H = J.transpose() * J;

  const double inertia = (params.inertia_kg_mm2 + hold.inertia_kg_mm2) / kMmPerM;  // N mm s^2/rad
  const Mat6 mass = diagonal(params.mass_kg / kMmPerM, inertia) + hold.mass_kg / kMmPerM * at_H;
  const Mat6 damping =
      diagonal(params.viscosity_ns_per_mm, params.turning_viscosity_nmms + hold.turning_damping_nmms_per_rad) +
      hold.damping_ns_per_mm * at_H;
  const Mat6 stiffness = diagonal(0.0, hold.turning_nmm_per_rad) + hold.stiffness_n_per_mm * at_H;

  const Vec3 way = hold.X_PS * Vec3(0.0, 0.0, hold.point_mm) - (state.X_PS.p() + r_SH);
  const Vec3 anchor_velocity = hold.velocity_P + hold.angular_velocity_P.cross(hold.point_mm * hold.X_PS.R().col(2));
  const Vec3 to_centre = state.w_P.cross(state.w_P.cross(r_SH));  // acceleration of H that is not in the velocities
  const Vec3 on_H = hold.stiffness_n_per_mm * way + hold.damping_ns_per_mm * anchor_velocity + hold.push_n -
                    hold.mass_kg / kMmPerM * to_centre;
  const Vec3 weight = gravity_P * params.weight_n;
  Vec3 turn = wrench_P.torque_nmm - params.weight_lever_mm * z_P.cross(weight) +
              hold.turning_damping_nmms_per_rad * hold.angular_velocity_P;
  if (hold.turning_nmm_per_rad > 0.0) {
    turn += hold.turning_nmm_per_rad * rotation_vector(hold.X_PS.R() * state.X_PS.R().transpose());
  }
  const Vec6 push = stacked(wrench_P.force_n + weight, turn) + J.transpose() * on_H;
  return {mass + half_s * (damping + half_s * stiffness), mass * stacked(state.v_P, state.w_P) + half_s * push};
}

/// Dry friction on three of the six velocities. `impulse`: its present value.
struct DryFriction {
  int first = 0;      ///< Impulse at which it slips.
  double most = 0.0;  ///< Impulse at which it slides.
  Vec3 impulse = Vec3::Zero();
  bool stands = false;
};

/// The friction that stops its joint, or its maximum against the motion. `mobility`: velocity per impulse.
void rub(DryFriction& friction, const Mat6& mobility, Vec6& velocities) noexcept {
  if (!(friction.most > 0.0)) return;
  const Mat3 own = mobility.block<3, 3>(friction.first, friction.first);
  const Vec3 without = velocities.segment<3>(friction.first) - own * friction.impulse;
  Vec3 impulse = -own.ldlt().solve(without);
  const double norm = impulse.norm();
  friction.stands = norm <= friction.most;
  if (!friction.stands) impulse *= friction.most / norm;
  velocities += mobility.middleCols<3>(friction.first) * (impulse - friction.impulse);
  friction.impulse = impulse;
}

}  // namespace

StylusMotion step_stylus(VirtualStylusState& state, const VirtualStylusParams& params, const StylusHold& hold,
                         const Wrench& wrench_P, const Vec3& gravity_P, double dt_s) noexcept {
  const double half_s = 0.5 * dt_s;
  const MovingBody body = moving_body(state, params, hold, wrench_P, gravity_P, dt_s);
  const Eigen::LDLT<Mat6> factors(body.A);
  Vec6 mean = factors.solve(body.b);

  DryFriction arm{0, half_s * params.friction_n};
  DryFriction gimbal{3, half_s * params.turning_friction_nmm};
  if (arm.most > 0.0 || gimbal.most > 0.0) {
    constexpr int kRounds = 4;  // each uses the last result of the other
    const Mat6 mobility = factors.solve(Mat6::Identity());
    for (int i = 0; i < kRounds; ++i) {
      rub(arm, mobility, mean);
      rub(gimbal, mobility, mean);
    }
  }
  const Vec3 v = arm.stands ? Vec3::Zero() : Vec3(mean.head<3>());
  const Vec3 w = gimbal.stands ? Vec3::Zero() : Vec3(mean.tail<3>());
  const Eigen::Quaterniond turned(rotation_from_vector(dt_s * w) * state.X_PS.R());
  state.X_PS = Pose(turned.normalized().toRotationMatrix(), state.X_PS.p() + dt_s * v);
  state.v_P = arm.stands ? Vec3::Zero() : Vec3(2.0 * v - state.v_P);
  state.w_P = gimbal.stands ? Vec3::Zero() : Vec3(2.0 * w - state.w_P);
  return {v, w};
}

StylusHold make_hand() noexcept {
  StylusHold hand;
  hand.stiffness_n_per_mm = 0.6;
  hand.damping_ns_per_mm = 0.012;
  hand.mass_kg = 0.15;
  hand.turning_nmm_per_rad = 300.0;
  hand.turning_damping_nmms_per_rad = 8.0;
  hand.inertia_kg_mm2 = 50.0;
  return hand;
}

StylusHold make_guiding_hand(double tip_mm) noexcept {
  StylusHold hand = make_hand();
  hand.point_mm = tip_mm;
  // 0.1 kg at the stylus, 150 mm away: follows with the 0.08 s of H1 without oscillation.
  hand.turning_nmm_per_rad = 1500.0;
  hand.turning_damping_nmms_per_rad = 120.0;
  return hand;
}

void step_device(VirtualDeviceState& state, const VirtualDeviceParams& params, const HandHold& hand,
                 const Vec3& force_P, const Vec3& gravity_P, double dt_s) noexcept {
  constexpr double kMmPerM = 1000.0;
  const double mass = (params.mass_kg + hand.mass_kg) / kMmPerM;  // N s^2/mm
  const double k = hand.stiffness_n_per_mm;
  const double b = hand.damping_ns_per_mm;
  const Vec3 outer = force_P + gravity_P * params.weight_n;
  // Implicit Euler in the hand's spring and damper: m dv/dt = k (anchor - p) + b (v_anchor - v) + outer.
  const Vec3 push = k * (hand.anchor_P - state.X_PN.p()) + b * hand.anchor_velocity_P + outer;
  state.v_P = (mass * state.v_P + dt_s * push) / (mass + dt_s * b + dt_s * dt_s * k);
  state.X_PN = Pose(hand.R_PN, state.X_PN.p() + dt_s * state.v_P);
}

}  // namespace trocar::stylus
