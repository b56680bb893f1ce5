#include "anatomy/detail/merge_small_parts.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "volume/morphology.h"

namespace trocar::anatomy::detail {
namespace {

struct SmallParts {
  struct Voxel {
    std::size_t offset = 0;
    std::size_t part = 0;
  };
  std::vector<Voxel> voxels;
  std::size_t count = 0;
};

void add_small_parts(const volume::LabelGrid& labels, std::uint8_t id, std::size_t min_voxels, SmallParts& small) {
  volume::MaskGrid mask(labels.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = labels.voxels[n] == id ? 1 : 0;
  const volume::Components parts = volume::connected_components(mask);
  // Parts are sorted by decreasing size: the small ones come last.
  const auto first_small = std::find_if(parts.voxel_counts.begin(), parts.voxel_counts.end(),
                                        [&](std::size_t voxels) { return voxels < min_voxels; });
  const auto large_count = static_cast<std::size_t>(first_small - parts.voxel_counts.begin());
  for (std::size_t n = 0; n < parts.ids.voxels.size(); ++n) {
    const auto part = static_cast<std::size_t>(parts.ids.voxels[n]);
    if (part > large_count) small.voxels.push_back({n, small.count + part - large_count - 1});
  }
  small.count += parts.voxel_counts.size() - large_count;
}

}  // namespace

void merge_small_parts(volume::LabelGrid& labels, std::span<const std::uint8_t> ids, std::size_t min_voxels) {
  SmallParts small;
  for (const std::uint8_t id : ids) add_small_parts(labels, id, min_voxels, small);

  // Small parts are removed first, so that each is compared with large parts only.
  std::array<std::size_t, 256> column_of{};  // 0: none of `ids`
  for (std::size_t n = 0; n < ids.size(); ++n) column_of[ids[n]] = n + 1;
  const std::size_t columns = ids.size() + 1;
  std::vector<std::uint8_t> own(small.voxels.size());
  for (std::size_t n = 0; n < small.voxels.size(); ++n)
    own[n] = std::exchange(labels.voxels[small.voxels[n].offset], std::uint8_t{0});

  std::vector<std::uint32_t> contacts(small.count * columns, 0);
  for (const auto& [offset, part] : small.voxels) {
    const volume::Index3 ijk = labels.geometry.index_of(offset);
    for (std::size_t a = 0; a < 3; ++a) {
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 beside = ijk;
        beside[a] += step;
        if (labels.geometry.contains(beside)) ++contacts[part * columns + column_of[labels[beside]]];
      }
    }
  }
  for (std::size_t n = 0; n < small.voxels.size(); ++n) {
    const auto& [offset, part] = small.voxels[n];
    const std::uint32_t* first = contacts.data() + part * columns + 1;
    const std::uint32_t* most = std::max_element(first, first + ids.size());
    labels.voxels[offset] = *most == 0 ? own[n] : ids[static_cast<std::size_t>(most - first)];
  }
}

}  // namespace trocar::anatomy::detail
