#include "anatomy/derive/detail/posterior_wall.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::anatomy::detail {
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

}  // namespace trocar::anatomy::detail
