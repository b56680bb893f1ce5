#include "anatomy/derive/detail/canal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "volume/morphology.h"

namespace trocar::anatomy::detail {
namespace {

constexpr double kRingGapMm = 3.0;    // assumed: gaps in a ring that are closed: thin laminae, joints
constexpr double kMinRingMm2 = 60.0;  // assumed: the area of a canal is 150 to 500 mm2
constexpr double kMaxRingMm2 = 900.0;
constexpr std::int64_t kSmoothing = 1;  // slices to each side

/// Fills slices between found ones linearly.
void interpolate(std::vector<CanalSlice>& slices) {
  std::size_t last = slices.size();
  for (std::size_t n = 0; n < slices.size(); ++n) {
    if (!slices[n].is_found) continue;
    for (std::size_t m = last + 1; last < slices.size() && m < n; ++m) {
      const double f = static_cast<double>(m - last) / static_cast<double>(n - last);
      const auto mix = [&](double a, double b) { return a + f * (b - a); };
      slices[m] = {mix(slices[last].i, slices[n].i), mix(slices[last].j, slices[n].j),
                   mix(slices[last].half_width_mm, slices[n].half_width_mm), true};
    }
    last = n;
  }
}

/// Mean over neighbouring slices.
void smooth(std::vector<CanalSlice>& slices) {
  const std::vector<CanalSlice> raw = slices;
  const auto count = static_cast<std::int64_t>(raw.size());
  for (std::int64_t n = 0; n < count; ++n) {
    if (!raw[static_cast<std::size_t>(n)].is_found) continue;
    CanalSlice sum;
    double weight = 0.0;
    for (std::int64_t m = std::max<std::int64_t>(0, n - kSmoothing); m <= std::min(count - 1, n + kSmoothing); ++m) {
      const CanalSlice& s = raw[static_cast<std::size_t>(m)];
      if (!s.is_found) continue;
      sum.i += s.i;
      sum.j += s.j;
      sum.half_width_mm += s.half_width_mm;
      weight += 1.0;
    }
    slices[static_cast<std::size_t>(n)] = {sum.i / weight, sum.j / weight, sum.half_width_mm / weight, true};
  }
}

std::uint8_t find_cord(const DerivedLabels& labels) {
  for (const char* name : {"spinal_cord", "spinal_canal"}) {
    const Label* label = labels.patient().label_table.find(name);
    if (label != nullptr && labels.boxes().voxels[label->id] > 0) return label->id;
  }
  return 0;
}

/// Centroid and extent of the voxels of a slice.
struct SliceSum {
  double i = 0.0, j = 0.0, count = 0.0;
  std::int64_t low_i = 0, high_i = -1;

  void add(std::int64_t at_i, std::int64_t at_j) {
    if (count == 0.0) low_i = high_i = at_i;
    low_i = std::min(low_i, at_i);
    high_i = std::max(high_i, at_i);
    i += static_cast<double>(at_i);
    j += static_cast<double>(at_j);
    count += 1.0;
  }
  CanalSlice slice(double spacing_i_mm) const {
    return {i / count, j / count, 0.5 * spacing_i_mm * static_cast<double>(high_i - low_i + 1), true};
  }
};

Canal from_cord(const DerivedLabels& labels, std::uint8_t cord) {
  const IndexBox& box = labels.boxes().box[cord];
  Canal canal{box.low[2], std::vector<CanalSlice>(static_cast<std::size_t>(box.high[2] - box.low[2] + 1)), cord};
  std::vector<SliceSum> sums(canal.slices.size());
  for_each_in(labels.geometry(), box, [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
    if (labels.at(n) == cord) sums[static_cast<std::size_t>(ijk[2] - box.low[2])].add(ijk[0], ijk[1]);
  });
  for (std::size_t n = 0; n < sums.size(); ++n)
    if (sums[n].count > 0.0) canal.slices[n] = sums[n].slice(labels.geometry().spacing_mm.x());
  return canal;
}

/// The hole of the ring in one slice of the vertebrae: of the right size, the one farthest back if there are several.
CanalSlice ring_hole(const volume::MaskGrid& holes, const IndexBox& box, std::int64_t k) {
  volume::GridGeometry flat = holes.geometry;
  flat.size[2] = 1;
  volume::MaskGrid slice(flat);
  std::copy_n(holes.voxels.begin() + static_cast<std::ptrdiff_t>(holes.geometry.offset({0, 0, k - box.low[2]})),
              slice.voxels.size(), slice.voxels.begin());
  const volume::Components parts = volume::connected_components(slice);
  const double voxel_mm2 = flat.spacing_mm.x() * flat.spacing_mm.y();
  std::vector<SliceSum> sums(parts.voxel_counts.size());
  for (std::size_t n = 0; n < slice.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    const volume::Index3 ijk = flat.index_of(n);
    sums[static_cast<std::size_t>(parts.ids.voxels[n] - 1)].add(box.low[0] + ijk[0], box.low[1] + ijk[1]);
  }
  CanalSlice best;
  for (const SliceSum& sum : sums) {
    const double area_mm2 = sum.count * voxel_mm2;
    if (area_mm2 < kMinRingMm2 || area_mm2 > kMaxRingMm2) continue;
    const CanalSlice slice_of = sum.slice(flat.spacing_mm.x());
    if (!best.is_found || slice_of.j > best.j) best = slice_of;
  }
  return best;
}

std::optional<Canal> from_rings(const DerivedLabels& labels, const SpineLabels& spine) {
  const IndexBox box = grown(spine.box, 2.0 * kRingGapMm, labels.geometry());
  const volume::MaskGrid bone =
      cut_mask(labels.patient().labels, box, [&](std::uint8_t id) { return spine.place[id] != 0; });
  const volume::MaskGrid closed = volume::erode(volume::dilate(bone, kRingGapMm), kRingGapMm);
  volume::MaskGrid holes = volume::fill_holes_in_slices(closed);
  for (std::size_t n = 0; n < holes.voxels.size(); ++n) holes.voxels[n] = holes.voxels[n] && !closed.voxels[n] ? 1 : 0;
  Canal canal{box.low[2], std::vector<CanalSlice>(static_cast<std::size_t>(box.high[2] - box.low[2] + 1)), 0};
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    canal.slices[static_cast<std::size_t>(k - box.low[2])] = ring_hole(holes, box, k);
  const bool is_any = std::any_of(canal.slices.begin(), canal.slices.end(), [](const auto& s) { return s.is_found; });
  return is_any ? std::optional(std::move(canal)) : std::nullopt;
}

}  // namespace

const CanalSlice* Canal::at(std::int64_t k) const noexcept {
  if (k < first_k || k > last_k()) return nullptr;
  const CanalSlice& slice = slices[static_cast<std::size_t>(k - first_k)];
  return slice.is_found ? &slice : nullptr;
}

std::optional<Canal> find_canal(const DerivedLabels& labels, const SpineLabels& spine) {
  if (spine.count < 2) return std::nullopt;
  const std::uint8_t cord = find_cord(labels);
  std::optional<Canal> canal = cord != 0 ? std::optional(from_cord(labels, cord)) : from_rings(labels, spine);
  if (!canal) return std::nullopt;
  interpolate(canal->slices);
  smooth(canal->slices);
  return canal;
}

}  // namespace trocar::anatomy::detail
