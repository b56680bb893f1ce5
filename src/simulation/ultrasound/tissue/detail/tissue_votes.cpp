#include "ultrasound/tissue/detail/tissue_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/result.h"
#include "ultrasound/tissue/detail/tissue_volume.h"

namespace trocar::ultrasound::detail {
namespace {

/// Weight of the vote of a voxel in a structure of 3 or more, of 1 and of 2 voxels' thickness. Chosen so that a wall of
/// one voxel wins in a strip about as wide as the kernel's spacing, for any position between target voxels (tested).
constexpr std::array<float, 3> kVoteFactor{1.0F, 2.6F, 1.4F};

double cubic_b_spline(double x) {
  const double d = std::abs(x);
  if (d < 1.0) return 2.0 / 3.0 - d * d + 0.5 * d * d * d;
  if (d < 2.0) return (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0;
  return 0.0;
}

}  // namespace

AxisTaps make_taps(std::int64_t source_size, std::int64_t target_size, double offset, double step) {
  TROCAR_CHECK(source_size > 0 && step > 0.0);
  const double width = std::max(1.0, step);
  AxisTaps taps;
  taps.count = static_cast<int>(std::min<std::int64_t>(static_cast<std::int64_t>(std::ceil(4.0 * width)), source_size));
  for (std::int64_t n = 0; n < target_size; ++n) {
    const double at = offset + static_cast<double>(n) * step;
    const auto first =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(at - 2.0 * width)), 0, source_size - taps.count);
    taps.first.push_back(static_cast<std::int32_t>(first));
    // Beyond the source's edge its last voxel continues.
    const double inside = std::clamp(at, 0.0, static_cast<double>(source_size - 1));
    double sum = 0.0;
    std::vector<double> weights;
    for (int t = 0; t < taps.count; ++t) {
      weights.push_back(cubic_b_spline((inside - static_cast<double>(first + t)) / width));
      sum += weights.back();
    }
    for (const double weight : weights) taps.weights.push_back(static_cast<float>(weight / sum));
  }
  return taps;
}

TissueVotes::TissueVotes(std::int64_t width, std::int64_t height, AxisTaps along_u, AxisTaps along_v)
    : width_(width),
      height_(height),
      along_u_(std::move(along_u)),
      along_v_(std::move(along_v)),
      row_mixed_(static_cast<std::size_t>(width * height)),
      window_mixed_(row_mixed_.size()),
      thin_(row_mixed_.size()),
      boost_(row_mixed_.size()),
      votes_(256, 0.0F) {}

void TissueVotes::set_slice(const std::vector<std::uint8_t>& tissue) {
  TROCAR_CHECK(tissue.size() == row_mixed_.size());
  tissue_ = tissue.data();
  find_uniform();
  find_thin();
}

void TissueVotes::find_uniform() {
  for (std::int64_t v = 0; v < height_; ++v) {
    const std::uint8_t* row = tissue_ + v * width_;
    std::uint8_t* mixed = row_mixed_.data() + v * width_;
    std::fill(mixed, mixed + width_, std::uint8_t{0});
    for (std::int64_t t = 1; t < along_u_.count; ++t) {
      for (std::int64_t u = 0; u < width_ - t; ++u)
        mixed[u] = static_cast<std::uint8_t>(mixed[u] | (row[u] ^ row[u + t]));
    }
  }
  for (std::int64_t v = 0; v + along_v_.count <= height_; ++v) {
    const std::uint8_t* row = tissue_ + v * width_;
    std::uint8_t* mixed = window_mixed_.data() + v * width_;
    std::copy_n(row_mixed_.data() + v * width_, width_, mixed);
    for (std::int64_t t = 1; t < along_v_.count; ++t) {
      const std::uint8_t* below = row + t * width_;
      const std::uint8_t* below_mixed = row_mixed_.data() + (v + t) * width_;
      for (std::int64_t u = 0; u < width_; ++u)
        mixed[u] = static_cast<std::uint8_t>(mixed[u] | below_mixed[u] | (row[u] ^ below[u]));
    }
  }
}

void TissueVotes::find_thin() {
  // Thickness along either axis, without the two outermost voxels, which count as thick.
  std::fill(thin_.begin(), thin_.end(), std::uint8_t{0});
  for (const std::int64_t step : {std::int64_t{1}, width_}) {
    for (std::int64_t v = 2; v < height_ - 2; ++v) {
      const std::uint8_t* row = tissue_ + v * width_;
      std::uint8_t* thin = thin_.data() + v * width_;
      for (std::int64_t u = 2; u < width_ - 2; ++u) {
        const std::uint8_t own = row[u];
        const bool before = row[u - step] == own, before_2 = row[u - 2 * step] == own;
        const bool after = row[u + step] == own, after_2 = row[u + 2 * step] == own;
        const bool is_one = !before & !after;
        const bool is_two = (before & !before_2 & !after) | (after & !after_2 & !before);
        const auto found = static_cast<std::uint8_t>(is_one ? 1 : is_two ? 2 : 0);
        const std::uint8_t known = thin[u];
        thin[u] = known == 0 || (found != 0 && found < known) ? found : known;
      }
    }
  }
  std::fill(boost_.begin(), boost_.end(), std::uint8_t{0});
  for (std::int64_t v = 2; v < height_ - 2; ++v) {
    const std::uint8_t* thin = thin_.data() + v * width_;
    for (std::int64_t u = 2; u < width_ - 2; ++u) {
      if (thin[u] != 0 && is_thin_structure(u, v)) boost_[static_cast<std::size_t>(v * width_ + u)] = thin[u];
    }
  }
}

/// A bump on a thick structure is also thin, but its neighbours are not: it is smoothed, not kept.
bool TissueVotes::is_thin_structure(std::int64_t u, std::int64_t v) const noexcept {
  const std::uint8_t own = tissue_[v * width_ + u];
  int thin = 0;
  int thick = 0;
  for (std::int64_t dv = -1; dv <= 1; ++dv) {
    for (std::int64_t du = -1; du <= 1; ++du) {
      const std::int64_t n = (v + dv) * width_ + u + du;
      if ((du == 0 && dv == 0) || tissue_[n] != own) continue;
      ++(thin_[static_cast<std::size_t>(n)] != 0 ? thin : thick);
    }
  }
  return thin >= thick;
}

std::uint8_t TissueVotes::winner(std::size_t target_u, std::size_t target_v) noexcept {
  const std::int64_t first_u = along_u_.first[target_u];
  const std::int64_t first_v = along_v_.first[target_v];
  const std::int64_t corner = first_v * width_ + first_u;
  if (window_mixed_[static_cast<std::size_t>(corner)] == 0) return tissue_[corner];

  std::array<std::uint8_t, 64> seen;
  std::size_t seen_count = 0;
  const float* weight_u = along_u_.weights.data() + target_u * static_cast<std::size_t>(along_u_.count);
  const float* weight_v = along_v_.weights.data() + target_v * static_cast<std::size_t>(along_v_.count);
  for (int tv = 0; tv < along_v_.count; ++tv) {
    const std::int64_t row = corner + tv * width_;
    for (int tu = 0; tu < along_u_.count; ++tu) {
      const std::uint8_t tissue = tissue_[row + tu];
      const float vote = weight_u[tu] * weight_v[tv] * kVoteFactor[boost_[static_cast<std::size_t>(row + tu)]];
      if (tissue == kNoTissue || vote <= 0.0F) continue;
      if (votes_[tissue] == 0.0F && seen_count < seen.size()) seen[seen_count++] = tissue;
      votes_[tissue] += vote;
    }
  }
  std::uint8_t best = kNoTissue;
  float most = 0.0F;
  for (std::size_t n = 0; n < seen_count; ++n) {
    const std::uint8_t tissue = seen[n];
    // Of equal votes the smaller index wins, independent of the order of the taps.
    if (votes_[tissue] > most || (votes_[tissue] == most && tissue < best)) {
      most = votes_[tissue];
      best = tissue;
    }
    votes_[tissue] = 0.0F;
  }
  return best;
}

}  // namespace trocar::ultrasound::detail
