#include "xray/projection/xray_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/files/folders.h"
#include "core/parallel.h"
#include "volume/sampling.h"
#include "xray/physics/materials.h"
#include "xray/projection/detail/row_stack.h"
#include "xray/projection/detail/slab_kernels.h"

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

namespace {

using detail::IndexRays;
using detail::RowStack;
using detail::RowsView;
using detail::SlabPlan;
using detail::SlabSums;

constexpr std::size_t kGrainSums = 8, kGrainRows = 16;  ///< Rows of a part of the work.
constexpr float kCmPerMm = 0.1F;

/// The rows that a plan walks: along index axis 0 of the volume, or along axis 1 in the transposed copy.
template <class Voxel>
RowsView<Voxel> view_of(const RowStack<Voxel>& stack, const SlabPlan& plan) {
  RowsView<Voxel> view{stack.rows.data(), stack.voxels.data(), stack.length, stack.size_a, 1, stack.size_a};
  // Rows of a stack are numbered by axes (1, 2), or (0, 2) if transposed. Slices across the first of them:
  if (plan.axis_n != 2) {
    view.count_y = stack.size_b;
    std::swap(view.stride_y, view.stride_n);
  }
  return view;
}

template <class Voxel>
SlabSums sum_plan(const RowStack<Voxel>& stack, const SlabPlan& plan, std::size_t channels) {
  SlabSums sums;
  sums.stride = static_cast<std::size_t>(plan.columns) + detail::kSamplePadding;
  for (std::size_t c = 0; c < channels; ++c) sums.channels[c].resize(sums.stride * static_cast<std::size_t>(plan.rows));
  const RowsView<Voxel> view = view_of(stack, plan);
  parallel_for(static_cast<std::size_t>(plan.rows), kGrainSums, [&](std::size_t first, std::size_t last) {
    detail::sum_slices(view, plan, static_cast<int>(first), static_cast<int>(last), sums);
  });
  return sums;
}

/// Projects a volume: `stack_for(plan)` is its rows, `images` are zero.
template <class StackFor>
void project_stack(const IndexRays& rays, int columns, int rows, const std::array<std::int64_t, 3>& size,
                   const StackFor& stack_for, std::span<float* const> images, float factor) {
  for (const SlabPlan& plan : detail::plan_slabs(rays, columns, rows, size)) {
    if (plan.columns == 0) continue;
    const SlabSums sums = sum_plan(stack_for(plan), plan, images.size());
    parallel_for(static_cast<std::size_t>(plan.tile.rows), kGrainRows, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = 0; c < images.size(); ++c)
        detail::read_sums(sums, static_cast<int>(c), plan, rays, factor, static_cast<int>(first),
                          static_cast<int>(last), columns, images[c]);
    });
  }
}

RowStack<float> rows_of(const volume::FloatGrid& grid, bool is_transposed) {
  const auto [i, j, k] = grid.geometry.size;
  const float* const voxels = grid.voxels.data();
  if (is_transposed)
    return detail::make_row_stack<float>(j, i, k,
                                         [=, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
                                           return voxels[(b * size_j + x) * size_i + a];
                                         });
  return detail::make_row_stack<float>(i, j, k,
                                       [=, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
                                         return voxels[(b * size_j + a) * size_i + x];
                                       });
}

}  // namespace

void project(const XrayVolume& volume, const XrayRays& rays, MassImage& masses) {
  const XrayVolume::Impl& impl = volume.impl();
  masses.columns = rays.columns;
  masses.rows = rays.rows;
  float* images[2] = {};
  for (const Basis basis : {Basis::kWater, Basis::kBone}) {
    std::vector<float>& image = masses.of(basis);
    image.assign(masses.size(), 0.0F);
    images[static_cast<std::size_t>(basis)] = image.data();
  }
  const IndexRays in_volume = detail::index_rays(rays, impl.geometry);
  const auto stack_for = [&](const SlabPlan& plan) -> const RowStack<detail::PackedVoxel>& {
    return plan.axis_n == 0 ? impl.transposed : impl.rows;
  };
  project_stack(in_volume, rays.columns, rays.rows, impl.geometry.size, stack_for, images,
                kCmPerMm * static_cast<float>(detail::kPackedUnit_g_per_cm3));
}

void project(const volume::FloatGrid& grid, const XrayRays& rays, std::vector<float>& integrals) {
  integrals.assign(
      static_cast<std::size_t>(std::max(rays.columns, 0)) * static_cast<std::size_t>(std::max(rays.rows, 0)), 0.0F);
  if (grid.empty()) return;
  float* const images[1] = {integrals.data()};
  const auto stack_for = [&](const SlabPlan& plan) { return rows_of(grid, plan.axis_n == 0); };
  project_stack(detail::index_rays(rays, grid.geometry), rays.columns, rays.rows, grid.geometry.size, stack_for, images,
                kCmPerMm);
}

}  // namespace trocar::xray
