#include "patient_builder/derive/detail/canal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "volume/morphology.h"

namespace trocar::patient_builder::detail {
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
    const anatomy::Label* label = labels.patient().label_table.find(name);
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

namespace {

// Assumed lengths; a lumbar canal is 15 to 25 mm deep and 20 to 30 mm wide.
constexpr double kSideMm = 14.0;          // of the wall to each side of the canal's centre
constexpr double kBehindCentreMm = 28.0;  // search behind the centre
constexpr double kMidlineMm = 4.5;        // columns that count as the midline
constexpr double kFartherMm = 5.0;        // bone this much farther than the lamina is a spinous process above or below
constexpr double kLongestLaminaGapMm = 32.0;  // between the laminae of two vertebrae
constexpr double kNearestMm = 2.0;            // bone at the centre is no wall

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

PosteriorWall::PosteriorWall(const DerivedLabels& labels, const SpineLabels& spine, const Canal& canal)
    : geometry_(labels.geometry()), first_k_(canal.first_k), rows_(static_cast<std::int64_t>(canal.slices.size())) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CanalSlice& slice : canal.slices) {
    if (!slice.is_found) continue;
    low = std::min(low, slice.i);
    high = std::max(high, slice.i);
  }
  const double side = kSideMm / geometry_.spacing_mm.x();
  first_i_ = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(low - side)));
  columns_ = std::min(geometry_.size[0] - 1, static_cast<std::int64_t>(std::ceil(high + side))) - first_i_ + 1;
  cells_.resize(static_cast<std::size_t>(columns_ * rows_));
  find_faces(labels, spine, canal);
  remove_far_faces(canal);
  bridge_gaps();
}

void PosteriorWall::find_faces(const DerivedLabels& labels, const SpineLabels& spine, const Canal& canal) {
  const Vec3& spacing = geometry_.spacing_mm;
  for (std::int64_t k = first_k_; k <= last_k(); ++k) {
    const CanalSlice* slice = canal.at(k);
    if (slice == nullptr) continue;
    const auto centre_j = static_cast<std::int64_t>(std::lround(slice->j));
    const auto last_j = std::min(geometry_.size[1] - 1,
                                 centre_j + static_cast<std::int64_t>(std::lround(kBehindCentreMm / spacing.y())));
    for (std::int64_t i = first_i_; i <= last_i(); ++i) {
      if (std::abs(static_cast<double>(i) - slice->i) * spacing.x() > kSideMm) continue;
      for (std::int64_t j = centre_j; j <= last_j; ++j) {
        const std::uint8_t place = spine.place[labels.at(geometry_.offset({i, j, k}))];
        if (place == 0) continue;
        if (static_cast<double>(j - centre_j) * spacing.y() >= kNearestMm)
          cell(i, k) = {static_cast<float>(j) - 0.5F, place, place};
        break;
      }
    }
  }
}

/// Keeps the inner faces of laminae: between two laminae the first bone behind the canal is a spinous process.
void PosteriorWall::remove_far_faces(const Canal& canal) {
  const Vec3& spacing = geometry_.spacing_mm;
  const auto depth_mm = [&](const Cell& c, const CanalSlice& s) {
    return (static_cast<double>(c.face_j) - s.j) * spacing.y();
  };
  std::array<std::vector<double>, 28> midline;
  for (std::int64_t k = first_k_; k <= last_k(); ++k)
    for (std::int64_t i = first_i_; i <= last_i(); ++i) {
      const Cell& c = at(i, k);
      const CanalSlice* slice = canal.at(k);
      if (c.is_known() && std::abs(static_cast<double>(i) - slice->i) * spacing.x() <= kMidlineMm)
        midline[c.above].push_back(depth_mm(c, *slice));
    }
  for (std::int64_t k = first_k_; k <= last_k(); ++k)
    for (std::int64_t i = first_i_; i <= last_i(); ++i) {
      Cell& c = cell(i, k);
      if (!c.is_known()) continue;
      const bool is_far = midline[c.above].empty() || depth_mm(c, *canal.at(k)) > median(midline[c.above]) + kFartherMm;
      if (is_far) c = {};
    }
}

void PosteriorWall::bridge_gaps() {
  const auto longest = static_cast<std::int64_t>(std::floor(kLongestLaminaGapMm / geometry_.spacing_mm.z()));
  for (std::int64_t i = first_i_; i <= last_i(); ++i) {
    std::int64_t below_k = first_k_ - 1;
    for (std::int64_t k = first_k_; k <= last_k(); ++k) {
      if (!at(i, k).is_known()) continue;
      const bool is_gap = below_k >= first_k_ && k - below_k > 1 && k - below_k <= longest;
      if (is_gap) {
        const Cell low = at(i, below_k), high = at(i, k);
        const bool is_same = low.above == high.above;
        if (is_same || are_neighbours(high.above, low.above)) {
          for (std::int64_t m = below_k + 1; m < k; ++m) {
            const float f = static_cast<float>(m - below_k) / static_cast<float>(k - below_k);
            cell(i, m) = {low.face_j + f * (high.face_j - low.face_j), high.above, low.above};
          }
        }
      }
      below_k = k;
    }
  }
}

const PosteriorWall::Cell& PosteriorWall::at(std::int64_t i, std::int64_t k) const noexcept {
  static constexpr Cell kNone{};
  if (i < first_i_ || i > last_i() || k < first_k_ || k > last_k()) return kNone;
  return cells_[static_cast<std::size_t>((k - first_k_) * columns_ + i - first_i_)];
}

double PosteriorWall::slant(std::int64_t i, std::int64_t k) const noexcept {
  const Vec3& spacing = geometry_.spacing_mm;
  const auto slope = [&](const Cell& a, const Cell& b, double distance_mm) {
    return a.is_known() && b.is_known() ? static_cast<double>(b.face_j - a.face_j) * spacing.y() / distance_mm : 0.0;
  };
  const double across = slope(at(i - 1, k), at(i + 1, k), 2.0 * spacing.x());
  const double along = slope(at(i, k - 1), at(i, k + 1), 2.0 * spacing.z());
  return std::min(2.0, std::sqrt(1.0 + across * across + along * along));
}

}  // namespace trocar::patient_builder::detail
