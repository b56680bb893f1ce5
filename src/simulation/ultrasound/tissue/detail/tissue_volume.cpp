#include "ultrasound/tissue/detail/tissue_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/parallel.h"

namespace trocar::ultrasound::detail {
namespace {

// HU of unlabelled voxels besides kGasBelow_hu, as in src/patient/anatomy (adipose tissue up to -30 HU,
// doi 10.1038/s41598-025-96238-6, table 1). A built patient has no such voxels; a hand-made one may.
constexpr int kFatUpTo_hu = -30;
constexpr int kBoneAbove_hu = 250;

/// Smallest and greatest index of the body along each axis.
struct Bounds {
  volume::Index3 low{INT64_MAX, INT64_MAX, INT64_MAX};
  volume::Index3 high{-1, -1, -1};

  void include(const Bounds& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
};

Bounds slice_bounds(const volume::FloatGrid& skin_distance_mm, std::int64_t k) {
  Bounds bounds;
  const volume::Index3& size = skin_distance_mm.geometry.size;
  for (std::int64_t j = 0; j < size[1]; ++j) {
    const float* row = skin_distance_mm.voxels.data() + skin_distance_mm.geometry.offset({0, j, k});
    const auto is_inside = [](float distance_mm) { return distance_mm < 0.0F; };
    const float* first = std::find_if(row, row + size[0], is_inside);
    if (first == row + size[0]) continue;
    const float* last = row + size[0] - 1;
    while (!is_inside(*last)) --last;
    bounds.include({{first - row, j, k}, {last - row, j, k}});
  }
  return bounds;
}

Bounds body_bounds(const volume::FloatGrid& skin_distance_mm) {
  const auto slices = static_cast<std::size_t>(skin_distance_mm.geometry.size[2]);
  std::vector<Bounds> by_slice(slices);
  parallel_for(slices, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      by_slice[k] = slice_bounds(skin_distance_mm, static_cast<std::int64_t>(k));
  });
  Bounds all;
  for (const Bounds& bounds : by_slice) all.include(bounds);
  return all;
}

/// The axes in cyclic order (right-handed) with the thickest voxels last; k, if it is not clearly thinner than another.
std::array<std::size_t, 3> order_axes(const Vec3& spacing_mm) {
  constexpr double kClearly = 1.2;
  std::size_t thickest = 2;
  for (std::size_t a = 0; a < 2; ++a) {
    if (spacing_mm[static_cast<Eigen::Index>(a)] > kClearly * spacing_mm[static_cast<Eigen::Index>(thickest)])
      thickest = a;
  }
  return {(thickest + 1) % 3, (thickest + 2) % 3, thickest};
}

/// Acoustic tissues of a patient's labels.
struct TissueCodes {
  std::array<std::uint8_t, 256> by_label{};
  std::array<bool, 256> holds_gas{};  ///< Segmented bowel includes its contents.
  std::uint8_t gas = 0, fat = 0, bone = 0, soft_tissue = 0;

  std::uint8_t of(std::uint8_t label, int hu) const noexcept {
    const bool is_gas = hu < kGasBelow_hu;
    if (label != 0) return is_gas && holds_gas[label] ? gas : by_label[label];
    if (is_gas) return gas;
    if (hu <= kFatUpTo_hu) return fat;
    return hu > kBoneAbove_hu ? bone : soft_tissue;
  }
};

Result<std::uint8_t> find_code(const AcousticTable& table, std::string_view tissue, std::string_view needed_by) {
  if (const auto code = table.find(tissue)) return *code;
  return fail(fmt::format("the acoustic table has no tissue \"{}\"", tissue), std::string(needed_by),
              "add a row of that name to data/acoustics.toml");
}

Result<TissueCodes> make_codes(const anatomy::LabelTable& labels, const AcousticTable& table) {
  constexpr std::string_view kUnlabelled = "unlabelled parts of the body";
  TissueCodes codes;
  TROCAR_TRY(codes.gas, find_code(table, "gas", kUnlabelled));
  TROCAR_TRY(codes.fat, find_code(table, "adipose", kUnlabelled));
  TROCAR_TRY(codes.bone, find_code(table, "bone", kUnlabelled));
  TROCAR_TRY(codes.soft_tissue, find_code(table, "soft_tissue", kUnlabelled));
  codes.by_label.fill(codes.soft_tissue);
  for (const anatomy::Label& label : labels.labels) {
    TROCAR_TRY(codes.by_label[label.id], find_code(table, label.tissue, fmt::format("label \"{}\"", label.name)));
    codes.holds_gas[label.id] = label.tissue == "bowel";
  }
  return codes;
}

}  // namespace

Result<BodyWindow> find_body_window(const anatomy::VirtualPatient& patient, double margin_mm) {
  const volume::GridGeometry& grid = patient.labels.geometry;
  if (patient.labels.empty()) return fail("the patient has no voxels", patient.name, "build the patient again");
  Bounds box = body_bounds(patient.skin_distance_mm);
  if (box.high[0] < 0)
    return fail("the patient has no body: no voxel lies inside the skin", patient.name, "build the patient again");
  if (!std::isfinite(patient.skin_distance_mm[box.low]))
    return fail("no skin is in the patient's volume", patient.name,
                "build the patient from a CT that shows air around the body");
  for (std::size_t a = 0; a < 3; ++a) {
    const auto margin = static_cast<std::int64_t>(std::ceil(margin_mm / grid.spacing_mm[static_cast<Eigen::Index>(a)]));
    box.low[a] = std::max<std::int64_t>(box.low[a] - margin, 0);
    box.high[a] = std::min(box.high[a] + margin, grid.size[a] - 1);
  }

  const std::array<std::size_t, 3> axes = order_axes(grid.spacing_mm);
  const std::array<std::size_t, 3> grid_stride{1, static_cast<std::size_t>(grid.size[0]),
                                               static_cast<std::size_t>(grid.size[0] * grid.size[1])};
  BodyWindow window;
  window.first = grid.offset(box.low);
  window.geometry.origin_P = grid.centre_mm(box.low);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto to = static_cast<Eigen::Index>(n);
    const auto from = static_cast<Eigen::Index>(axes[n]);
    window.stride[n] = grid_stride[axes[n]];
    window.geometry.size[n] = box.high[axes[n]] - box.low[axes[n]] + 1;
    window.geometry.spacing_mm[to] = grid.spacing_mm[from];
    window.geometry.R_PV.col(to) = grid.R_PV.col(from);
  }
  return window;
}

Status check_tissues(const anatomy::LabelTable& labels, const AcousticTable& table) {
  TROCAR_TRY_STATUS(make_codes(labels, table));
  return {};
}

Result<TissueVolume> make_tissue_volume(const anatomy::VirtualPatient& patient, const BodyWindow& window,
                                        const AcousticTable& table) {
  TROCAR_TRY(const TissueCodes codes, make_codes(patient.label_table, table));
  TissueVolume volume;
  volume.geometry = window.geometry;
  volume.gas = codes.gas;
  volume.tissue.resize(window.geometry.voxel_count());
  const volume::Index3& size = window.geometry.size;
  parallel_for(static_cast<std::size_t>(size[1] * size[2]), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const auto v = static_cast<std::int64_t>(row) % size[1];
      const auto w = static_cast<std::int64_t>(row) / size[1];
      std::uint8_t* out = volume.tissue.data() + row * static_cast<std::size_t>(size[0]);
      std::size_t n = window.patient_offset(0, v, w);
      for (std::int64_t u = 0; u < size[0]; ++u, n += window.stride[0]) {
        const bool is_inside = patient.skin_distance_mm.voxels[n] < 0.0F;
        out[u] = is_inside ? codes.of(patient.labels.voxels[n], patient.ct.voxels[n]) : kNoTissue;
      }
    }
  });
  return volume;
}

}  // namespace trocar::ultrasound::detail
