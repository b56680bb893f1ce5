#include "haptics/contact_column.h"

#include <algorithm>
#include <cmath>

namespace trocar {
namespace {

constexpr double kMaxStrain = 0.98;
constexpr double kLeastLength_mm = 0.5;
constexpr double kNPerMm2PerKpa = 1e-3;

/// Young's modulus over HU: HuTransfer::at for this one number.
double young_of_hu(const HuTransfer& transfer, double hu) noexcept {
  if (!(hu > transfer.hu[0])) return transfer.laws[0].young_kpa;
  for (std::size_t i = 1; i < transfer.knot_count; ++i) {
    if (!(hu < transfer.hu[i])) continue;
    const double t = (hu - transfer.hu[i - 1]) / (transfer.hu[i] - transfer.hu[i - 1]);
    const double below = transfer.laws[i - 1].young_kpa;
    return below + t * (transfer.laws[i].young_kpa - below);
  }
  return transfer.laws[transfer.knot_count - 1].young_kpa;
}

/// Reads moduli along a ray in voxel indices. Beyond the volume its edge continues.
class Ray {
 public:
  Ray(const HapticScene& scene, const Vec3& from_P, const Vec3& direction_P) noexcept
      : scene_(scene),
        geometry_(scene.patient->skin_distance_mm.geometry),
        from_(geometry_.to_index(from_P) + Vec3::Constant(0.5)),
        step_((geometry_.R_PV.transpose() * direction_P).cwiseQuotient(geometry_.spacing_mm)) {}

  double young_kpa(double depth_mm) const noexcept {
    if (depth_mm < scene_.skin_thickness_mm) return scene_.tissues[scene_.skin].young_kpa;
    const std::size_t voxel = voxel_at(depth_mm);
    const VirtualPatient& patient = *scene_.patient;
    const std::uint8_t label = patient.labels.empty() ? std::uint8_t{0} : patient.labels.voxels[voxel];
    if (label == 0 && scene_.transfer.knot_count > 0 && !patient.ct.empty())
      return young_of_hu(scene_.transfer, patient.ct.voxels[voxel]);
    return scene_.tissues[scene_.tissue_of_label[label]].young_kpa;
  }

 private:
  std::size_t voxel_at(double depth_mm) const noexcept {
    const Vec3 index = from_ + depth_mm * step_;
    Index3 ijk;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto last = static_cast<double>(geometry_.size[a] - 1);
      const double v = index[static_cast<int>(a)];
      ijk[a] = static_cast<std::int64_t>(v > 0.0 ? std::min(v, last) : 0.0);  // NaN becomes 0
    }
    return geometry_.offset(ijk);
  }

  const HapticScene& scene_;
  const GridGeometry& geometry_;
  Vec3 from_;
  Vec3 step_;
};

/// Where between two depths the tissue becomes rigid.
double rigid_from_mm(const Ray& ray, double soft_mm, double rigid_mm) noexcept {
  constexpr int kHalvings = 4;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (soft_mm + rigid_mm);
    (ray.young_kpa(middle) >= kRigid_kpa ? rigid_mm : soft_mm) = middle;
  }
  return 0.5 * (soft_mm + rigid_mm);
}

}  // namespace

TissueColumn tissue_column(const HapticScene& scene, const Vec3& skin_point_P, const Vec3& inward_P) noexcept {
  constexpr double kCell_mm = kColumn_mm / kColumnCells;
  constexpr double kPlaneStrain = 1.0 - kPoisson * kPoisson;
  const Ray ray(scene, skin_point_P, inward_P);
  const ContactFace& face = scene.face;
  TissueColumn column;
  double yields = 0.0;  // mm/kPa
  double modulus = std::max(ray.young_kpa(0.0), kSoftest_kpa);
  double above_mm = 0.0;
  for (std::size_t cell = 0; cell < kColumnCells; ++cell) {
    const double middle_mm = (static_cast<double>(cell) + 0.5) * kCell_mm;
    const double young = std::max(ray.young_kpa(middle_mm), kSoftest_kpa);
    if (young >= kRigid_kpa) {
      column.length_mm = std::max(rigid_from_mm(ray, above_mm, middle_mm), kLeastLength_mm);
      // The cell's border may lie on either side of the bone's.
      yields += (settlement_mm(column.length_mm, face.spread_mm) - face.settlement_mm[cell]) / modulus;
      break;
    }
    yields += (face.settlement_mm[cell + 1] - face.settlement_mm[cell]) / young;
    modulus = young;
    above_mm = middle_mm;
  }
  column.stiffness_n_per_mm3 = kNPerMm2PerKpa / (kPlaneStrain * yields);
  return column;
}

double column_pressure(const TissueColumn& column, double indentation_mm) noexcept {
  if (!(indentation_mm > 0.0)) return 0.0;
  const double strain = std::min(indentation_mm / column.length_mm, kMaxStrain);
  const double pressure = column.stiffness_n_per_mm3 * strain * column.length_mm / (1.0 - strain);
  return pressure + (indentation_mm - strain * column.length_mm) * column_tangent(column, indentation_mm);
}

double column_tangent(const TissueColumn& column, double indentation_mm) noexcept {
  if (!(indentation_mm > 0.0)) return 0.0;
  const double room = 1.0 - std::min(indentation_mm / column.length_mm, kMaxStrain);
  return column.stiffness_n_per_mm3 / (room * room);
}

}  // namespace trocar
