#include "haptics/contact/contact_balance.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
namespace {

constexpr int kSweeps = 2;
constexpr int kPressSteps = 30;
constexpr double kForceTolerance_n = 1e-9;
constexpr double kShare = 1.0 / (2.0 * (1.0 + kPoisson));  // shear modulus over Young's modulus
constexpr double kMaxTurn_rad = 0.05;

/// State of the solver of the balance.
class Solver {
 public:
  explicit Solver(const ContactBalance& balance) noexcept
      : b_(balance),
        count_(static_cast<std::size_t>(balance.count)),
        stiffness_(balance.coupling.stiffness_n_per_mm),
        rate_(balance.coupling.damping_ns_per_mm / balance.dt_s),
        ahead_(rate_ / stiffness_),
        lever2_(balance.lever_mm * balance.lever_mm) {
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      shear_n_per_mm_[i] = b_.engagement * kShare * point.area_mm2 * point.column.stiffness_n_per_mm3;
      lever_P_[i] = point.arm_P.cross(point.normal_P);
    }
  }

  ContactSolution run() noexcept {
    normal_ = mean_normal();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      press();
      evaluate();
      const Vec3 slide = slide_step();
      out_.turn_P += turn_step();
      out_.move_P += slide;
    }
    press();
    evaluate();
    out_.wrench_P.force_n = coupling_n();
    out_.wrench_P.torque_nmm = coupling_nmm();
    return out_;
  }

 private:
  Vec3 coupling_n() const noexcept { return stiffness_ * (b_.offset_P + out_.move_P) + rate_ * out_.move_P; }
  Vec3 coupling_nmm() const noexcept {
    return lever2_ * (stiffness_ * (b_.tilt_P + out_.turn_P) + rate_ * out_.turn_P);
  }
  Vec3 motion(const PressedPoint& point) const noexcept { return out_.move_P + out_.turn_P.cross(point.arm_P); }
  double depth_mm(const PressedPoint& point) const noexcept {
    return point.depth_mm - point.normal_P.dot(motion(point));
  }
  /// Tissue is a spring and a damper with the coupling's time constant: its response is that to the indentation at that
  /// time ahead.
  ColumnResponse respond_ahead(const PressedPoint& point, double depth) const noexcept {
    if (!(depth > 0.0)) return {};
    const ColumnResponse response = respond(point.column, depth + ahead_ * (depth - point.depth_before_mm));
    const double area = b_.engagement * point.area_mm2;
    return {area * response.pressure, area * (1.0 + ahead_) * response.tangent};
  }
  Vec3 mean_normal() const noexcept {
    Vec3 pressed = Vec3::Zero();
    Vec3 near = Vec3::Zero();
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      pressed += respond_ahead(point, point.depth_mm).pressure * point.normal_P;
      near += point.normal_P;
    }
    const Vec3& sum = pressed.norm() > 0.0 ? pressed : near;
    return sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
  }

  /// Moves the tool along the mean normal into balance. Contact minus coupling is convex and decreases with s: a Newton
  /// step ends left of the root from any start, and later steps only decrease.
  void press() noexcept {
    std::array<double, kMaxContactPoints> share;
    std::array<double, kMaxContactPoints> depth;
    for (std::size_t i = 0; i < count_; ++i) {
      share[i] = b_.points[i].normal_P.dot(normal_);
      depth[i] = depth_mm(b_.points[i]);
    }
    const double coupling = coupling_n().dot(normal_);
    double s = 0.0;
    out_.hit_bound = true;
    for (int i = 0; i < kPressSteps && out_.hit_bound; ++i) {
      double force = -coupling - (stiffness_ + rate_) * s;
      double slope = stiffness_ + rate_;
      for (std::size_t n = 0; n < count_; ++n) {
        const ColumnResponse response = respond_ahead(b_.points[n], depth[n] - share[n] * s);
        force += share[n] * response.pressure;
        slope += share[n] * share[n] * response.tangent;
      }
      out_.hit_bound = !(std::abs(force) < kForceTolerance_n);
      s += force / slope;
    }
    out_.move_P += s * normal_;
  }

  /// Friction of a point: the spring of the skin below it, at most mu times the normal force. True while it sticks.
  bool rub(std::size_t i) noexcept {
    const PressedPoint& point = b_.points[i];
    const double k = shear_n_per_mm_[i];
    const double limit_n = b_.friction_mu * out_.normal_n[i];
    if (!(k > 0.0) || !(limit_n > 0.0)) {
      out_.friction_P[i] = out_.stretch_P[i] = Vec3::Zero();
      return false;
    }
    const Vec3 step = motion(point);
    const Vec3 stretch = point.stretch_P + step - point.normal_P * point.normal_P.dot(step);
    const Vec3 ahead = stretch + ahead_ * (stretch - point.stretch_before_P);
    const double norm = ahead.norm();
    if (!(k * norm > limit_n)) {
      out_.friction_P[i] = -k * ahead;
      out_.stretch_P[i] = stretch;
      return true;
    }
    const double share = limit_n / (k * norm);  // the rest slides
    out_.friction_P[i] = -k * share * ahead;
    out_.stretch_P[i] = (ahead_ * point.stretch_before_P + share * ahead) / (1.0 + ahead_);
    return false;
  }

  /// All forces at the present pose of the tool, and their derivatives with respect to translation and rotation.
  void evaluate() noexcept {
    out_.contact_P = {};
    slide_n_per_mm_ = stiffness_ + rate_;
    turn_nmm_per_rad_ = Mat3::Identity() * (slide_n_per_mm_ * lever2_);
    for (std::size_t i = 0; i < count_; ++i) {
      const PressedPoint& point = b_.points[i];
      out_.depth_mm[i] = depth_mm(point);
      const ColumnResponse response = respond_ahead(point, out_.depth_mm[i]);
      out_.normal_n[i] = response.pressure;
      const bool sticks = rub(i);
      if (!(response.tangent > 0.0)) continue;
      const Vec3& arm = point.arm_P;
      const Vec3 force = out_.normal_n[i] * point.normal_P + out_.friction_P[i];
      out_.contact_P.force_n += force;
      out_.contact_P.torque_nmm += arm.cross(force);
      const Vec3& lever = lever_P_[i];
      const Vec3 weighted = response.tangent * lever;
      turn_nmm_per_rad_ += weighted * lever.transpose();
      if (!sticks) continue;
      const double shear = (1.0 + ahead_) * shear_n_per_mm_[i];
      slide_n_per_mm_ += shear;
      turn_nmm_per_rad_ -= shear * (lever * lever.transpose() + arm * arm.transpose());
      turn_nmm_per_rad_.diagonal().array() += shear * arm.squaredNorm();
    }
  }

  /// Step of the tool across the mean normal towards the balance of friction and coupling.
  Vec3 slide_step() const noexcept {
    const Vec3 rest = out_.contact_P.force_n - coupling_n();
    return (rest - normal_ * normal_.dot(rest)) / slide_n_per_mm_;
  }
  /// The same for rotation and torques.
  Vec3 turn_step() const noexcept {
    const Vec3 step = turn_nmm_per_rad_.inverse() * (out_.contact_P.torque_nmm - coupling_nmm());
    const double angle = step.norm();
    return angle > kMaxTurn_rad ? Vec3(step * (kMaxTurn_rad / angle)) : step;
  }

  const ContactBalance& b_;
  std::size_t count_;
  double stiffness_;
  double rate_;   // N/mm: damping over dt
  double ahead_;  // prediction time of the tissue's damping in ticks
  double lever2_;
  std::array<double, kMaxContactPoints> shear_n_per_mm_;
  std::array<Vec3, kMaxContactPoints> lever_P_;  // rotates the tool: arm x normal
  Vec3 normal_ = Vec3::UnitZ();
  double slide_n_per_mm_ = 0.0;
  Mat3 turn_nmm_per_rad_ = Mat3::Zero();
  ContactSolution out_;
};

}  // namespace

ContactSolution solve(const ContactBalance& balance) noexcept {
  return Solver(balance).run();
}

namespace {

constexpr double kTiny_mm = 1e-9;
constexpr double kLeastLength_mm = 0.5;

/// Young's modulus over HU: HuTransfer::at for this number only.
double young_of_hu(const anatomy::HuTransfer& transfer, double hu) noexcept {
  if (!(hu > transfer.hu[0])) return transfer.laws[0].young_kpa;
  for (std::size_t i = 1; i < transfer.knot_count; ++i) {
    if (!(hu < transfer.hu[i])) continue;
    const double t = (hu - transfer.hu[i - 1]) / (transfer.hu[i] - transfer.hu[i - 1]);
    const double below = transfer.laws[i - 1].young_kpa;
    return below + t * (transfer.laws[i].young_kpa - below);
  }
  return transfer.laws[transfer.knot_count - 1].young_kpa;
}

/// Ligaments: the table has their modulus in tension along the fibres, which bear no pressure across them
/// (docs/physics.md B9). [assumed] Range of the modulus across: 20..200 kPa.
double across_fibres_kpa(double young_kpa) noexcept {
  constexpr double kFibrous_kpa = 5e3, kBone_kpa = 5e4, kAcross_kpa = 50.0;
  return young_kpa >= kFibrous_kpa && young_kpa < kBone_kpa ? kAcross_kpa : young_kpa;
}

/// Reads moduli along a ray in voxel indices, straight now; where the patient moves, each place is looked up at rest,
/// as tissue may slide below the skin. Outside the volume its edge continues.
class Ray {
 public:
  Ray(const PatientNow& now, const Vec3& from_P, const Vec3& direction_P) noexcept
      : now_(now),
        geometry_(now.scene.patient->skin_distance_mm.geometry),
        from_P_(from_P),
        direction_P_(direction_P),
        from_(geometry_.to_index(from_P) + Vec3::Constant(0.5)),
        step_((geometry_.R_PV.transpose() * direction_P).cwiseQuotient(geometry_.spacing_mm)),
        is_inside_(now.motion.is_rest() && holds(from_) && holds(from_ + kColumn_mm * step_)) {}

  double soft_kpa(double depth_mm) const noexcept { return std::max(young_kpa(depth_mm), kSoftest_kpa); }

 private:
  double young_kpa(double depth_mm) const noexcept {
    const HapticScene& scene = now_.scene;
    if (depth_mm < scene.skin_thickness_mm) return scene.tissues[scene.skin].young_kpa;
    const std::size_t voxel = voxel_at(depth_mm);
    const anatomy::VirtualPatient& patient = *scene.patient;
    const std::uint8_t label = patient.labels.empty() ? std::uint8_t{0} : patient.labels.voxels[voxel];
    if (label == 0 && scene.transfer.knot_count > 0 && !patient.ct.empty())
      return young_of_hu(scene.transfer, patient.ct.voxels[voxel]);
    return across_fibres_kpa(scene.tissues[scene.tissue_of_label[label]].young_kpa);
  }

  Vec3 at(double depth_mm) const noexcept {
    if (now_.motion.is_rest()) return from_ + depth_mm * step_;
    return geometry_.to_index(now_.motion.to_rest(from_P_ + depth_mm * direction_P_)) + Vec3::Constant(0.5);
  }
  bool holds(const Vec3& index) const noexcept {
    return index.x() >= 0.0 && index.y() >= 0.0 && index.z() >= 0.0 &&
           index.x() < static_cast<double>(geometry_.size[0]) && index.y() < static_cast<double>(geometry_.size[1]) &&
           index.z() < static_cast<double>(geometry_.size[2]);
  }
  std::size_t voxel_at(double depth_mm) const noexcept {
    const Vec3 index = at(depth_mm);
    if (is_inside_) {
      return geometry_.offset({static_cast<std::int64_t>(index.x()), static_cast<std::int64_t>(index.y()),
                               static_cast<std::int64_t>(index.z())});
    }
    volume::Index3 ijk;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto last = static_cast<double>(geometry_.size[a] - 1);
      const double v = index[static_cast<int>(a)];
      ijk[a] = static_cast<std::int64_t>(v > 0.0 ? std::min(v, last) : 0.0);  // NaN becomes 0
    }
    return geometry_.offset(ijk);
  }

  const PatientNow& now_;
  const volume::GridGeometry& geometry_;
  Vec3 from_P_, direction_P_;
  Vec3 from_;  ///< At rest: index, and index per mm.
  Vec3 step_;
  bool is_inside_;
};

/// Depth between two limits at which the tissue becomes rigid.
double rigid_from_mm(const Ray& ray, double soft_mm, double rigid_mm) noexcept {
  constexpr int kHalvings = 4;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (soft_mm + rigid_mm);
    (ray.soft_kpa(middle) >= kRigid_kpa ? rigid_mm : soft_mm) = middle;
  }
  return 0.5 * (soft_mm + rigid_mm);
}

}  // namespace

TissueColumn tissue_column(const PatientNow& now, const Vec3& skin_point_P, const Vec3& inward_P) noexcept {
  constexpr double kPlaneStrain = 1.0 - kPoisson * kPoisson;
  const Ray ray(now, skin_point_P, inward_P);
  const ContactFace& face = now.scene.face;
  TissueColumn column;
  double yields = 0.0;   // mm/kPa, of layers in series
  double squares = 0.0;  // mm/kPa^2
  double young = ray.soft_kpa(0.0);
  double yield = 1.0 / young;
  double above_mm = 0.0;
  const auto add = [&](double settlement, double thickness_mm) {
    const double yielding = settlement * yield;
    yields += yielding;
    squares += yielding * yielding / thickness_mm;
  };
  for (std::size_t cell = 0; cell < kColumnCells; ++cell) {
    const double middle_mm = 0.5 * (kCellBorder_mm[cell] + kCellBorder_mm[cell + 1]);
    const double here = ray.soft_kpa(middle_mm);
    if (here >= kRigid_kpa) {
      column.length_mm = std::max(rigid_from_mm(ray, above_mm, middle_mm), kLeastLength_mm);
      // The bone can start on either side of the cell's border.
      const double more_mm = column.length_mm - kCellBorder_mm[cell];
      if (std::abs(more_mm) > kTiny_mm)
        add(settlement_mm(column.length_mm, face.spread_mm) - face.settlement_mm[cell], more_mm);
      break;
    }
    if (here != young) yield = 1.0 / (young = here);
    add(face.settlement_mm[cell + 1] - face.settlement_mm[cell], kCellBorder_mm[cell + 1] - kCellBorder_mm[cell]);
    above_mm = middle_mm;
  }
  column.stiffening_per_mm = std::max(squares / (yields * yields) - 1.0 / column.length_mm, 0.0);
  column.stiffness_n_per_mm3 = kNPerMm2PerKpa / (kPlaneStrain * yields);
  return column;
}

}  // namespace trocar::haptics
