#include "phantom/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"

namespace trocar::phantom {
namespace {

constexpr double kBlockMm = 6.5;

/// Voxels [low, high) of a grid, small enough that few structures overlap it.
struct Block {
  volume::Index3 low, high;
};

class Painter {
 public:
  Painter(const Anatomy& anatomy, const volume::GridGeometry& geometry, Culling culling, Rendering& out)
      : anatomy_(anatomy), geometry_(geometry), culling_(culling), out_(out) {
    scale_ = anatomy.scale();
    for (const anatomy::Label& label : anatomy.label_table.labels) phase_hu_[label.id] = anatomy.phase_hu(label.name);
    brush_.blur_mm = static_cast<float>(std::cbrt(geometry.voxel_volume_mm3())) / scale_;
    for (std::size_t a = 0; a < 3; ++a) {
      block_size_[a] = std::max<std::int64_t>(1, std::lround(kBlockMm / geometry.spacing_mm[static_cast<int>(a)]));
      blocks_[a] = (geometry.size[a] + block_size_[a] - 1) / block_size_[a];
    }
  }

  std::size_t layers() const { return static_cast<std::size_t>(blocks_[2]); }

  void paint_layer(std::size_t layer) const {
    std::vector<const Structure*> near;
    for (std::int64_t j = 0; j < blocks_[1]; ++j) {
      cancellation_point();
      for (std::int64_t i = 0; i < blocks_[0]; ++i) {
        const Block block = block_at({i, j, static_cast<std::int64_t>(layer)});
        find_near(block, near);
        paint_block(block, near);
      }
    }
  }

 private:
  Block block_at(const volume::Index3& index) const {
    Block block;
    for (std::size_t a = 0; a < 3; ++a) {
      block.low[a] = index[a] * block_size_[a];
      block.high[a] = std::min(block.low[a] + block_size_[a], geometry_.size[a]);
    }
    return block;
  }

  /// In the reference body.
  Vec3f voxel_centre(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const Vec3 p_P = geometry_.to_mm(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
    return p_P.cast<float>() / scale_;
  }

  /// The structures that can be visible in a block, in painting order, without those outside it and those covered
  /// completely.
  void find_near(const Block& block, std::vector<const Structure*>& near) const {
    near.clear();
    const Vec3f first = voxel_centre(block.low[0], block.low[1], block.low[2]);
    const Vec3f last = voxel_centre(block.high[0] - 1, block.high[1] - 1, block.high[2] - 1);
    const Vec3f centre = 0.5F * (first + last);
    const float reach = kSteepness * 0.5F * (last - first).norm() + brush_.blur_mm;
    const Box box = Box{first, last}.grown(brush_.blur_mm);
    const Place place = anatomy_.torso.at(centre);
    for (const Structure& structure : anatomy_.structures) {
      if (culling_ == Culling::kEvery) {
        near.push_back(&structure);
        continue;
      }
      if (!structure.bounds.overlaps(box)) continue;
      const float distance = structure.distance(place);
      if (distance > reach) continue;
      const bool fills = distance < -reach && (structure.bounds.low.array() < first.array()).all() &&
                         (structure.bounds.high.array() > last.array()).all();
      if (fills) near.clear();
      near.push_back(&structure);
    }
  }

  void paint_block(const Block& block, const std::vector<const Structure*>& near) const {
    for (std::int64_t k = block.low[2]; k < block.high[2]; ++k)
      for (std::int64_t j = block.low[1]; j < block.high[1]; ++j)
        for (std::int64_t i = block.low[0]; i < block.high[0]; ++i) {
          const Place place = anatomy_.torso.at(voxel_centre(i, j, k));
          const Paint paint = paint_place(place, near);
          const std::size_t offset = geometry_.offset({i, j, k});
          out_.ct.voxels[offset] = static_cast<std::int16_t>(std::lround(paint.hu));
          out_.labels.voxels[offset] = paint.label;
          out_.skin_distance_mm.voxels[offset] = place.skin * scale_;
        }
  }

  Paint paint_place(const Place& place, const std::vector<const Structure*>& near) const {
    Paint result{kAirHu, 0};
    const Box here = Box{place.p, place.p}.grown(brush_.blur_mm);
    for (const Structure* structure : near) {
      if (!structure->bounds.overlaps(here)) continue;
      const float distance = structure->distance(place);
      const float cover = brush_.cover(distance);
      if (cover <= 0.0F) continue;
      Paint paint = structure->paint(place, distance, brush_);
      paint.hu += phase_hu_[paint.label];
      result.hu = cover < 1.0F ? mix(result.hu, paint.hu, cover) : paint.hu;
      if (distance < 0.0F) result.label = paint.label;
    }
    if (place.skin >= 0.0F) result.label = 0;
    return result;
  }

  const Anatomy& anatomy_;
  const volume::GridGeometry& geometry_;
  Culling culling_;
  Rendering& out_;
  Brush brush_;
  std::array<float, 256> phase_hu_{};
  float scale_ = 1.0F;  ///< Size of the patient, 1 for the reference body.
  volume::Index3 block_size_{1, 1, 1};
  volume::Index3 blocks_{0, 0, 0};
};

}  // namespace

Rendering render(const Anatomy& anatomy, const volume::GridGeometry& geometry, const Progress& progress,
                 Culling culling) {
  Rendering out{volume::CtGrid(geometry), volume::LabelGrid(geometry), volume::FloatGrid(geometry)};
  const Painter painter(anatomy, geometry, culling, out);
  // A few layers at a time, so that the calling thread reports the progress.
  constexpr std::size_t kBatch = 4;
  for (std::size_t first = 0; first < painter.layers(); first += kBatch) {
    report(progress, "rendering the anatomy", static_cast<double>(first) / static_cast<double>(painter.layers()));
    const std::size_t count = std::min(kBatch, painter.layers() - first);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t layer = begin; layer < end; ++layer) painter.paint_layer(first + layer);
    });
  }
  report(progress, "adding noise", 1.0);
  add_scanner_noise(out.ct, out.skin_distance_mm, anatomy.seed, anatomy.body.noise_hu);
  return out;
}

namespace {

constexpr float kSkinShare = 0.82F, kMiddleShare = 1.18F;  ///< Of the noise half way.
constexpr float kMiddleMm = 90.0F;
/// A Gaussian of 0.75 voxels in the slice, a weaker one across slices.
constexpr std::array<float, 5> kInPlane{0.0152F, 0.2186F, 0.5324F, 0.2186F, 0.0152F};
constexpr std::array<float, 3> kAcross{0.2F, 0.6F, 0.2F};

/// Shares of the standard deviation: their squares add up to 1. With them the noise power falls between 0.12 and 0.44
/// cycles a mm as much as in the liver of a real CT (docs/validation.md).
constexpr float kSmoothShare = 0.787F, kRoughShare = 0.617F;

template <std::size_t N>
constexpr float energy(const std::array<float, N>& kernel) {
  float sum = 0.0F;
  for (const float w : kernel) sum += w * w;
  return sum;
}

/// Nearly normal, mean 0, variance 1: the sum of four uniform 16-bit numbers.
float white(std::uint64_t key, std::uint64_t counter) {
  const std::uint64_t bits = mix64(key ^ counter);
  const auto sum =
      static_cast<float>((bits & 0xffffU) + ((bits >> 16) & 0xffffU) + ((bits >> 32) & 0xffffU) + (bits >> 48));
  return (sum - 131070.0F) * (1.7320508F / 65536.0F);
}

class SliceNoise {
 public:
  SliceNoise(const volume::GridGeometry& geometry, std::uint64_t key)
      : columns_(geometry.size[0]),
        rows_(geometry.size[1]),
        key_(key),
        rough_(static_cast<std::size_t>((columns_ + 4) * (rows_ + 4))),
        values_(static_cast<std::size_t>(columns_ * rows_)) {}

  /// Noise of slice k, variance 1.
  const std::vector<float>& make(std::int64_t k) {
    fill_rough(k);
    filter(k);
    return values_;
  }

 private:
  void fill_rough(std::int64_t k) {
    const auto plane = static_cast<std::uint64_t>(rough_.size());
    for (std::uint64_t n = 0; n < plane; ++n) {
      float sum = 0.0F;
      for (std::uint64_t s = 0; s < kAcross.size(); ++s)
        sum += kAcross[s] * white(key_, (static_cast<std::uint64_t>(k) + s) * plane + n);
      rough_[n] = sum;
    }
  }

  void filter(std::int64_t k) {
    const float scale = 1.0F / (energy(kInPlane) * std::sqrt(energy(kAcross)));
    const auto wide = static_cast<std::size_t>(columns_ + 4);
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_ + 4); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i) {
        float sum = 0.0F;
        for (std::size_t s = 0; s < kInPlane.size(); ++s) sum += kInPlane[s] * rough_[j * wide + i + s];
        rough_[j * wide + i] = sum;  // only overwrites values that are no longer needed
      }
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i) {
        float sum = 0.0F;
        for (std::size_t s = 0; s < kInPlane.size(); ++s) sum += kInPlane[s] * rough_[(j + s) * wide + i];
        values_[j * static_cast<std::size_t>(columns_) + i] = kSmoothShare * scale * sum;
      }
    add_rough_share(k);
  }

  /// The part of the noise that the reconstruction leaves at the highest frequencies.
  void add_rough_share(std::int64_t k) {
    const std::uint64_t first = static_cast<std::uint64_t>(k) * static_cast<std::uint64_t>(values_.size());
    for (std::uint64_t n = 0; n < values_.size(); ++n) values_[n] += kRoughShare * white(~key_, first + n);
  }

  std::int64_t columns_, rows_;
  std::uint64_t key_;
  std::vector<float> rough_;
  std::vector<float> values_;
};

}  // namespace

void add_scanner_noise(volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, std::uint64_t seed,
                       double sigma_hu) {
  const auto half_way_hu = static_cast<float>(sigma_hu);
  const auto plane = static_cast<std::size_t>(ct.geometry.size[0] * ct.geometry.size[1]);
  parallel_for(static_cast<std::size_t>(ct.geometry.size[2]), 4, [&](std::size_t first, std::size_t last) {
    SliceNoise noise(ct.geometry, mix64(seed ^ 0x6e6f697365U));
    for (std::size_t k = first; k < last; ++k) {
      const std::vector<float>& values = noise.make(static_cast<std::int64_t>(k));
      for (std::size_t n = 0; n < plane; ++n) {
        const std::size_t offset = k * plane + n;
        const float depth = std::clamp(-skin_distance_mm.voxels[offset] / kMiddleMm, 0.0F, 1.0F);
        const float sigma = half_way_hu * (kSkinShare + (kMiddleShare - kSkinShare) * depth);
        const float hu = static_cast<float>(ct.voxels[offset]) + sigma * values[n];
        ct.voxels[offset] = static_cast<std::int16_t>(std::clamp(std::lround(hu), -1024L, 3071L));
      }
    }
  });
}

}  // namespace trocar::phantom
