#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "ultrasound/tissue/acoustic_scene.h"
#include "ultrasound/tissue/detail/tissue_volume.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr float kBorderWeight = 0.05F;      // assumed: a voxel at a border has both sides; only thin structures need it
constexpr float kGreatest_hu = 200.0F;      // assumed: beyond are streaks, calcifications and mislabelled voxels
constexpr float kSkinAndPartial_mm = 3.5F;  // assumed: skin with partial volume, labelled as fat
constexpr std::uint8_t kNeverEqual = 0xFE;  ///< Padding of rows: no tissue, different from kNoTissue.

/// Mean HU of each structure: a label, all gas, unlabelled voxels of one tissue.
class StructureMeans {
 public:
  StructureMeans(const anatomy::VirtualPatient& patient, const BodyWindow& window, const TissueVolume& volume)
      : gas_(volume.gas) {
    const volume::Index3& size = window.geometry.size;
    std::vector<Sums> by_slice(static_cast<std::size_t>(size[2]));
    parallel_for(by_slice.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t w = first; w < last; ++w)
        by_slice[w] = sum_slice(patient, window, volume, static_cast<std::int64_t>(w));
    });
    Sums all{};
    for (const Sums& sums : by_slice) {
      for (std::size_t s = 0; s < all.size(); ++s) {
        all[s].hu += sums[s].hu;
        all[s].voxels += sums[s].voxels;
      }
    }
    for (std::size_t s = 0; s < all.size(); ++s)
      mean_hu_[s] = all[s].voxels > 0 ? static_cast<float>(all[s].hu) / static_cast<float>(all[s].voxels) : 0.0F;
  }

  float deviation_hu(std::uint8_t label, std::uint8_t tissue, std::int16_t hu) const noexcept {
    return std::clamp(static_cast<float>(hu) - mean_hu_[structure(label, tissue)], -kGreatest_hu, kGreatest_hu);
  }

 private:
  struct Sum {
    std::int64_t hu = 0;
    std::int64_t voxels = 0;
  };
  using Sums = std::array<Sum, 512>;

  std::size_t structure(std::uint8_t label, std::uint8_t tissue) const noexcept {
    return label != 0 && tissue != gas_ ? label : std::size_t{256} + tissue;
  }

  Sums sum_slice(const anatomy::VirtualPatient& patient, const BodyWindow& window, const TissueVolume& volume,
                 std::int64_t w) const {
    Sums sums{};
    const std::uint8_t* tissue = volume.tissue_slice(w);
    for (std::int64_t v = 0; v < window.geometry.size[1]; ++v) {
      std::size_t n = window.patient_offset(0, v, w);
      for (std::int64_t u = 0; u < window.geometry.size[0]; ++u, ++tissue, n += window.stride[0]) {
        if (*tissue == kNoTissue) continue;
        Sum& sum = sums[structure(patient.labels.voxels[n], *tissue)];
        sum.hu += patient.ct.voxels[n];
        ++sum.voxels;
      }
    }
    return sums;
  }

  std::uint8_t gas_;
  std::array<float, 512> mean_hu_{};
};

/// One half of a Gaussian in voxels, centre first.
std::vector<float> half_kernel(double sigma_mm, double spacing_mm) {
  const double sigma = sigma_mm / spacing_mm;
  std::vector<float> weights;
  for (int step = 0; step <= static_cast<int>(std::ceil(2.0 * sigma)); ++step)
    weights.push_back(static_cast<float>(std::exp(-0.5 * step * step / (sigma * sigma))));
  return weights;
}

/// A slice of sums and weights with a rim of `rim` voxels without tissue. The normalised convolution sums both over the
/// neighbours of the same tissue, one axis after the other.
struct WeightedSlice {
  WeightedSlice(const volume::Index3& size, std::int64_t rim_)
      : width(size[0] + 2 * rim_),
        height(size[1] + 2 * rim_),
        rim(rim_),
        tissue(static_cast<std::size_t>(width * height), kNeverEqual),
        sum(tissue.size(), 0.0F),
        weight(tissue.size(), 0.0F) {}

  std::int64_t width, height, rim;
  std::vector<std::uint8_t> tissue;
  std::vector<float> sum, weight;

  std::size_t row(std::int64_t v) const noexcept { return static_cast<std::size_t>((v + rim) * width + rim); }
};

/// True if the six neighbours of a voxel have its tissue; false at the volume's border.
bool is_pure(const TissueVolume& volume, std::int64_t u, std::int64_t v, std::int64_t w, const std::uint8_t* at) {
  const volume::Index3& size = volume.geometry.size;
  const std::int64_t slice = size[0] * size[1];
  const std::uint8_t own = *at;
  return (u == 0 || at[-1] == own) && (u + 1 == size[0] || at[1] == own) && (v == 0 || at[-size[0]] == own) &&
         (v + 1 == size[1] || at[size[0]] == own) && (w == 0 || at[-slice] == own) &&
         (w + 1 == size[2] || at[slice] == own);
}

void fill_slice(const anatomy::VirtualPatient& patient, const BodyWindow& window, const StructureMeans& means,
                const TissueVolume& volume, std::int64_t w, WeightedSlice& slice) {
  const std::uint8_t* tissue = volume.tissue_slice(w);
  for (std::int64_t v = 0; v < window.geometry.size[1]; ++v) {
    std::size_t n = window.patient_offset(0, v, w);
    std::size_t to = slice.row(v);
    for (std::int64_t u = 0; u < window.geometry.size[0]; ++u, ++tissue, ++to, n += window.stride[0]) {
      slice.tissue[to] = *tissue;
      slice.weight[to] = 0.0F;
      slice.sum[to] = 0.0F;
      if (*tissue == kNoTissue) continue;
      const bool is_skin = patient.skin_distance_mm.voxels[n] > -kSkinAndPartial_mm;
      slice.weight[to] = !is_skin && is_pure(volume, u, v, w, tissue) ? 1.0F : kBorderWeight;
      slice.sum[to] = slice.weight[to] * means.deviation_hu(patient.labels.voxels[n], *tissue, patient.ct.voxels[n]);
    }
  }
}

/// One axis of the convolution: `step` from a voxel to its next. Results go to `out`.
void convolve(const WeightedSlice& in, const volume::Index3& size, std::int64_t step, const std::vector<float>& kernel,
              WeightedSlice& out) {
  for (std::int64_t v = 0; v < size[1]; ++v) {
    const std::size_t row = in.row(v);
    const std::uint8_t* own = in.tissue.data() + row;
    float* sum = out.sum.data() + row;
    float* weight = out.weight.data() + row;
    for (std::int64_t u = 0; u < size[0]; ++u) {
      sum[u] = in.sum[row + static_cast<std::size_t>(u)];
      weight[u] = in.weight[row + static_cast<std::size_t>(u)];
    }
    for (std::size_t k = 1; k < kernel.size(); ++k) {
      for (const std::int64_t shift : {-static_cast<std::int64_t>(k) * step, static_cast<std::int64_t>(k) * step}) {
        const auto from = static_cast<std::size_t>(static_cast<std::int64_t>(row) + shift);
        const std::uint8_t* other = in.tissue.data() + from;
        const float* other_sum = in.sum.data() + from;
        const float* other_weight = in.weight.data() + from;
        const float share = kernel[k];
        for (std::int64_t u = 0; u < size[0]; ++u) {
          const float mask = other[u] == own[u] ? share : 0.0F;
          sum[u] += mask * other_sum[u];
          weight[u] += mask * other_weight[u];
        }
      }
    }
  }
}

std::int8_t to_steps(float hu) {
  constexpr auto kPerStep = static_cast<float>(1.0 / kTextureStep_hu);
  return static_cast<std::int8_t>(std::lround(std::clamp(hu * kPerStep, -127.0F, 127.0F)));
}

/// The last axis, across the slices, for the rows of one slice.
void convolve_across(const TissueVolume& volume, const std::vector<std::int8_t>& in, std::int64_t w,
                     const std::vector<float>& kernel, std::vector<std::int8_t>& out) {
  const auto slice = static_cast<std::int64_t>(volume.slice_size());
  const std::int64_t reach = static_cast<std::int64_t>(kernel.size()) - 1;
  const std::int64_t first = std::max<std::int64_t>(-reach, -w);
  const std::int64_t last = std::min(reach, volume.geometry.size[2] - 1 - w);
  for (std::int64_t n = w * slice; n < (w + 1) * slice; ++n) {
    const std::uint8_t own = volume.tissue[static_cast<std::size_t>(n)];
    if (own == kNoTissue) continue;
    float sum = 0.0F;
    float weight = 0.0F;
    for (std::int64_t k = first; k <= last; ++k) {
      const auto other = static_cast<std::size_t>(n + k * slice);
      const float mask = volume.tissue[other] == own ? kernel[static_cast<std::size_t>(std::abs(k))] : 0.0F;
      sum += mask * static_cast<float>(in[other]);
      weight += mask;
    }
    out[static_cast<std::size_t>(n)] = static_cast<std::int8_t>(std::lround(sum / weight));
  }
}

}  // namespace

void make_texture(const anatomy::VirtualPatient& patient, const BodyWindow& window, double sigma_mm,
                  TissueVolume& volume) {
  const StructureMeans means(patient, window, volume);
  const volume::Index3& size = window.geometry.size;
  const auto slices = static_cast<std::size_t>(size[2]);
  const std::vector<float> kernel_u = half_kernel(sigma_mm, window.geometry.spacing_mm[0]);
  const std::vector<float> kernel_v = half_kernel(sigma_mm, window.geometry.spacing_mm[1]);
  const std::vector<float> kernel_w = half_kernel(sigma_mm, window.geometry.spacing_mm[2]);

  std::vector<std::int8_t> in_plane(volume.tissue.size(), 0);
  parallel_for(slices, 4, [&](std::size_t first, std::size_t last) {
    WeightedSlice a(size, static_cast<std::int64_t>(std::max(kernel_u.size(), kernel_v.size())));
    WeightedSlice b = a;
    for (std::size_t w = first; w < last; ++w) {
      fill_slice(patient, window, means, volume, static_cast<std::int64_t>(w), a);
      b.tissue = a.tissue;
      convolve(a, size, 1, kernel_u, b);
      convolve(b, size, b.width, kernel_v, a);
      std::int8_t* out = in_plane.data() + w * volume.slice_size();
      for (std::int64_t v = 0; v < size[1]; ++v) {
        for (std::int64_t u = 0; u < size[0]; ++u, ++out) {
          const std::size_t n = a.row(v) + static_cast<std::size_t>(u);
          *out = a.weight[n] > 0.0F ? to_steps(a.sum[n] / a.weight[n]) : std::int8_t{0};
        }
      }
    }
  });

  volume.texture.assign(volume.tissue.size(), 0);
  parallel_for(slices, 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t w = first; w < last; ++w)
      convolve_across(volume, in_plane, static_cast<std::int64_t>(w), kernel_w, volume.texture);
  });
}

}  // namespace trocar::ultrasound::detail
