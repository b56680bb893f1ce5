#include "haptics/contact_balance.h"

#include <algorithm>
#include <cmath>

namespace trocar {
namespace {

constexpr int kSweeps = 2;
constexpr int kSlidePasses = 4;
constexpr double kShare = 1.0 / (2.0 * (1.0 + kPoisson));  // shear modulus over Young's modulus
constexpr double kMaxTurn_rad = 0.05;

/// The balance while it is being solved.
class Solver {
 public:
  explicit Solver(const ContactBalance& balance) noexcept
      : b_(balance),
        count_(static_cast<std::size_t>(balance.count)),
        stiffness_(balance.coupling.stiffness_n_per_mm),
        rate_(balance.coupling.damping_ns_per_mm / balance.dt_s),
        ahead_(rate_ / stiffness_) {}

  ContactSolution run() noexcept {
    const Vec3 normal = mean_normal();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      press(normal);
      slide(normal);
      turn();
    }
    press(normal);
    evaluate();
    out_.wrench_P.force_n = coupling_n();
    out_.wrench_P.torque_nmm = coupling_nmm();
    return out_;
  }

 private:
  double lever2() const noexcept { return b_.lever_mm * b_.lever_mm; }
  Vec3 coupling_n() const noexcept { return stiffness_ * (b_.offset_P + out_.move_P) + rate_ * out_.move_P; }
  Vec3 coupling_nmm() const noexcept {
    return lever2() * (stiffness_ * (b_.tilt_P + out_.turn_P) + rate_ * out_.turn_P);
  }
  Vec3 motion(const PressedPoint& point) const noexcept { return out_.move_P + out_.turn_P.cross(point.arm_P); }
  double depth_mm(const PressedPoint& point) const noexcept {
    return point.depth_mm - point.normal_P.dot(motion(point));
  }
  /// Tissue is a spring and a damper with the coupling's time constant: it answers the indentation that far ahead.
  double ahead_mm(const PressedPoint& point, double depth) const noexcept {
    return depth > 0.0 ? depth + ahead_ * (depth - point.depth_before_mm) : 0.0;
  }
  double normal_n(const PressedPoint& point, double depth) const noexcept {
    return b_.engagement * point.area_mm2 * column_pressure(point.column, ahead_mm(point, depth));
  }
  double normal_n_per_mm(const PressedPoint& point, double depth) const noexcept {
    return b_.engagement * point.area_mm2 * (1.0 + ahead_) * column_tangent(point.column, ahead_mm(point, depth));
  }
  double shear_n_per_mm(const PressedPoint& point) const noexcept {
    return b_.engagement * kShare * point.area_mm2 * point.column.stiffness_n_per_mm3;
  }

  Vec3 mean_normal() const noexcept {
    Vec3 pressed = Vec3::Zero();
    Vec3 near = Vec3::Zero();
    for (std::size_t i = 0; i < count_; ++i) {
      pressed += normal_n(b_.points[i], b_.points[i].depth_mm) * b_.points[i].normal_P;
      near += b_.points[i].normal_P;
    }
    const Vec3& sum = pressed.norm() > 0.0 ? pressed : near;
    return sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
  }

  /// Contact minus coupling along the normal, the tool moved by `s` from where it is: falls with s.
  double unbalance_n(const Vec3& normal, double s) const noexcept {
    double sum = -coupling_n().dot(normal) - (stiffness_ + rate_) * s;
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      const double share = point.normal_P.dot(normal);
      sum += share * normal_n(point, depth_mm(point) - share * s);
    }
    return sum;
  }

  /// Moves the tool along the mean normal into balance.
  void press(const Vec3& normal) noexcept {
    // Without the skin the tool would follow the coupling; with it, it stays between that and the last point's exit.
    double low = -coupling_n().dot(normal) / (stiffness_ + rate_);
    double f_low = unbalance_n(normal, low);
    constexpr double kForceTolerance_n = 1e-9;
    if (!(f_low > kForceTolerance_n)) {
      out_.move_P += low * normal;
      return;
    }
    double high = low;
    for (std::size_t i = 0; i < count_; ++i) {
      const double share = b_.points[i].normal_P.dot(normal);
      if (share > 0.1) high = std::max(high, depth_mm(b_.points[i]) / share);
    }
    double f_high = unbalance_n(normal, high);
    double s = high;
    constexpr int kMaxSteps = 40;
    int side = 0;
    out_.hit_bound = !(f_high <= 0.0);
    for (int i = 0; i < kMaxSteps && !out_.hit_bound; ++i) {
      if (high - low < 1e-12) break;
      const double secant = (low * f_high - high * f_low) / (f_high - f_low);
      s = (i % 8 == 7 || !(secant > low && secant < high)) ? 0.5 * (low + high) : secant;
      const double f = unbalance_n(normal, s);
      if (std::abs(f) < kForceTolerance_n) break;
      (f > 0.0 ? low : high) = s;
      (f > 0.0 ? f_low : f_high) = f;
      const int now = f > 0.0 ? -1 : 1;
      if (now == side) (f > 0.0 ? f_high : f_low) *= 0.5;
      side = now;
      if (i + 1 == kMaxSteps) out_.hit_bound = true;
    }
    out_.move_P += s * normal;
  }

  /// Friction of a point: the spring of the skin under it, at most mu times the normal force. True while it sticks.
  bool rub(std::size_t i) noexcept {
    const PressedPoint& point = b_.points[i];
    const double k = shear_n_per_mm(point);
    const double limit_n = b_.friction_mu * out_.normal_n[i];
    if (!(k > 0.0) || !(limit_n > 0.0)) {
      out_.friction_P[i] = Vec3::Zero();
      out_.stretch_P[i] = Vec3::Zero();
      return false;
    }
    const Vec3 step = motion(point);
    const Vec3 stretch = point.stretch_P + step - point.normal_P * point.normal_P.dot(step);
    const Vec3 pull = -k * (stretch + ahead_ * (stretch - point.stretch_before_P));
    const double norm = pull.norm();
    const bool sticks = !(norm > limit_n);
    out_.friction_P[i] = sticks ? pull : Vec3(pull * (limit_n / norm));
    out_.stretch_P[i] =
        sticks ? stretch : Vec3((ahead_ * point.stretch_before_P - out_.friction_P[i] / k) / (1.0 + ahead_));
    return sticks;
  }

  void evaluate() noexcept {
    out_.contact_P = {};
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      out_.depth_mm[i] = depth_mm(point);
      out_.normal_n[i] = normal_n(point, out_.depth_mm[i]);
      sticks_[i] = rub(i);
      const Vec3 force = out_.normal_n[i] * point.normal_P + out_.friction_P[i];
      out_.contact_P.force_n += force;
      out_.contact_P.torque_nmm += point.arm_P.cross(force);
    }
  }

  /// Moves the tool across the mean normal until friction and the coupling balance.
  void slide(const Vec3& normal) noexcept {
    for (int pass = 0; pass < kSlidePasses; ++pass) {
      evaluate();
      Vec3 rest = out_.contact_P.force_n - coupling_n();
      rest -= normal * normal.dot(rest);
      constexpr double kForceTolerance_n = 1e-7;
      if (rest.norm() < kForceTolerance_n) return;
      double k = stiffness_ + rate_;
      for (std::size_t i = 0; i < count_; ++i) {
        if (sticks_[i]) k += (1.0 + ahead_) * shear_n_per_mm(b_.points[i]);
      }
      out_.move_P += rest / k;
    }
  }

  /// Turns the tool by one linear step towards the balance of torques.
  void turn() noexcept {
    evaluate();
    Mat3 k = Mat3::Identity() * ((stiffness_ + rate_) * lever2());
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      const Vec3 lever = point.arm_P.cross(point.normal_P);
      k += normal_n_per_mm(point, out_.depth_mm[i]) * lever * lever.transpose();
      if (!sticks_[i]) continue;
      const double shear = (1.0 + ahead_) * shear_n_per_mm(point);
      k += shear * (point.arm_P.squaredNorm() * Mat3::Identity() - point.arm_P * point.arm_P.transpose() -
                    lever * lever.transpose());
    }
    Vec3 step = k.inverse() * (out_.contact_P.torque_nmm - coupling_nmm());
    const double angle = step.norm();
    if (angle > kMaxTurn_rad) step *= kMaxTurn_rad / angle;
    out_.turn_P += step;
  }

  const ContactBalance& b_;
  std::size_t count_;
  double stiffness_;
  double rate_;   // N/mm: damping over dt
  double ahead_;  // ticks that the tissue's damping looks ahead
  std::array<bool, kMaxContactPoints> sticks_{};
  ContactSolution out_;
};

}  // namespace

ContactSolution solve(const ContactBalance& balance) noexcept {
  return Solver(balance).run();
}

}  // namespace trocar
