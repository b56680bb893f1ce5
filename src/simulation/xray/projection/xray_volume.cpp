#include "xray/projection/xray_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/files/data_dir.h"
#include "volume/sampling.h"
#include "xray/physics/materials.h"
#include "xray/projection/detail/packed_volume.h"

namespace trocar::xray {
namespace {

constexpr int kLowest_hu = -1024, kHighest_hu = 4095;
constexpr int kAir_hu = -950;            ///< Noise of air below.
constexpr double kOutside_mm = 2.0;      ///< Beyond the skin: air, clothes, the table.
constexpr double kAir_g_per_cm3 = 0.05;  ///< A voxel of a CT alone is air below.

using PackedCurve = std::vector<detail::PackedVoxel>;  ///< By HU, from kLowest_hu.

detail::PackedVoxel pack(const BasisDensity& density) {
  const auto rounded = [](double g_per_cm3) {
    constexpr double kLimit = std::numeric_limits<std::int16_t>::max();
    return static_cast<std::int16_t>(
        std::lround(std::clamp(g_per_cm3 / detail::kPackedUnit_g_per_cm3, -kLimit, kLimit)));
  };
  const auto water = static_cast<std::uint16_t>(rounded(density.water));
  const auto bone = static_cast<std::uint16_t>(rounded(density.bone));
  return static_cast<detail::PackedVoxel>(static_cast<std::uint32_t>(bone) << 16 | water);
}

PackedCurve pack_curve(const HuCurve& curve) {
  PackedCurve packed;
  for (int hu = kLowest_hu; hu <= kHighest_hu; ++hu)
    packed.push_back(hu < kAir_hu ? 0 : pack(curve.at(static_cast<double>(hu))));
  return packed;
}

detail::PackedVoxel look_up(const PackedCurve& curve, std::int16_t hu) {
  return curve[static_cast<std::size_t>(std::clamp<int>(hu, kLowest_hu, kHighest_hu) - kLowest_hu)];
}

Status check_ct(const volume::CtGrid& ct) {
  if (ct.empty() || ct.voxels.size() != ct.geometry.voxel_count())
    return fail("the patient has no CT, which X-ray images are computed from", "X-ray", "open a patient with a CT");
  return {};
}

}  // namespace

Result<std::shared_ptr<const XrayVolume>> XrayVolume::make(std::shared_ptr<const anatomy::VirtualPatient> patient) {
  if (!patient) return fail("no patient is open", "X-ray", "open a patient with a CT");
  TROCAR_TRY_STATUS(check_ct(patient->ct));
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(const XrayMaterials materials, load_xray_materials(data_folder / "xray_materials.toml"));

  // One curve for each label id; ids of one tissue share it.
  std::map<std::string, PackedCurve, std::less<>> curves;
  const PackedCurve unlabelled = pack_curve(materials.unlabelled);
  std::array<const PackedCurve*, 256> curve_of{};
  curve_of.fill(&unlabelled);
  for (const anatomy::Label& label : patient->label_table.labels) {
    const auto [at, is_new] = curves.try_emplace(label.tissue);
    if (is_new) at->second = pack_curve(materials.curve_of(label.tissue));
    curve_of[label.id] = &at->second;
  }
  const std::int16_t* const ct = patient->ct.voxels.data();
  const std::size_t count = patient->ct.voxels.size();
  const std::uint8_t* const labels = patient->labels.voxels.size() == count ? patient->labels.voxels.data() : nullptr;
  const float* const skin_mm =
      patient->skin_distance_mm.voxels.size() == count ? patient->skin_distance_mm.voxels.data() : nullptr;
  auto impl = std::make_shared<Impl>();
  impl->geometry = patient->ct.geometry;
  impl->fill([&](std::size_t n) -> detail::PackedVoxel {
    if (skin_mm != nullptr && skin_mm[n] > static_cast<float>(kOutside_mm)) return 0;
    return look_up(*curve_of[labels == nullptr ? 0 : labels[n]], ct[n]);
  });
  if (skin_mm != nullptr) impl->patient = std::move(patient);
  return std::make_shared<const XrayVolume>(std::move(impl));
}

Result<std::shared_ptr<const XrayVolume>> XrayVolume::from_ct(const volume::CtGrid& ct) {
  TROCAR_TRY_STATUS(check_ct(ct));
  const PackedCurve curve = pack_curve(water_and_bone_curve());
  auto impl = std::make_shared<Impl>();
  impl->geometry = ct.geometry;
  impl->fill([&](std::size_t n) { return look_up(curve, ct.voxels[n]); });
  return std::make_shared<const XrayVolume>(std::move(impl));
}

XrayVolume::XrayVolume(std::shared_ptr<const Impl> impl) noexcept : impl_(std::move(impl)) {}

const volume::GridGeometry& XrayVolume::geometry() const noexcept {
  return impl_->geometry;
}

bool XrayVolume::is_inside_body(const Vec3& p_P) const noexcept {
  if (impl_->patient)
    return volume::sample_nearest(impl_->patient->skin_distance_mm, impl_->motion.to_rest(p_P),
                                  static_cast<float>(kOutside_mm)) < 0.0F;
  const Vec3 index = impl_->geometry.to_index(p_P);
  if (!index.allFinite() || index.cwiseAbs().maxCoeff() > 1e6) return false;
  const volume::Index3 ijk{std::llround(index.x()), std::llround(index.y()), std::llround(index.z())};
  if (!impl_->geometry.contains(ijk)) return false;
  const detail::RowSpan& row = impl_->rows.rows[static_cast<std::size_t>(ijk[1] + ijk[2] * impl_->rows.size_a)];
  if (ijk[0] < row.begin || ijk[0] >= row.end) return false;
  const auto packed = static_cast<std::uint32_t>(impl_->rows.voxels[static_cast<std::size_t>(row.first + ijk[0])]);
  const auto water = static_cast<std::int16_t>(packed & 0xFFFFU), bone = static_cast<std::int16_t>(packed >> 16);
  return (water + bone) * detail::kPackedUnit_g_per_cm3 > kAir_g_per_cm3;
}

Status check_source(const XrayVolume& volume, const CArm& arm) {
  TROCAR_TRY_STATUS(check_c_arm(arm));
  const XrayRays rays = rays_of(arm);
  if (volume.is_inside_body(rays.source_P))
    return fail_usage("the X-ray source is inside the patient's body", "C-arm",
                      "enlarge the distance from the source to the isocentre, or move the isocentre");
  constexpr int kPlaces = 17;  // along each edge of the detector
  for (int row = 0; row < kPlaces; ++row)
    for (int column = 0; column < kPlaces; ++column) {
      const double share = (arm.pixels - 1.0) / (kPlaces - 1);
      if (volume.is_inside_body(rays.pixel_P(column * share, row * share)))
        return fail_usage("the detector is inside the patient's body", "C-arm",
                          "enlarge the distance from the source to the detector, or move the isocentre");
    }
  return {};
}

}  // namespace trocar::xray
