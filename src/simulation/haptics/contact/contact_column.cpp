#include "haptics/contact/contact_column.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
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
