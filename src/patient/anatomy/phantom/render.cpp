#include "anatomy/phantom/render.h"

#include <algorithm>
#include <cmath>

#include "anatomy/phantom/texture.h"
#include "core/cancellation.h"
#include "core/parallel.h"

namespace trocar::anatomy::phantom {
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
    for (const Label& label : anatomy.label_table.labels) phase_hu_[label.id] = anatomy.phase_hu(label.name);
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

}  // namespace trocar::anatomy::phantom
