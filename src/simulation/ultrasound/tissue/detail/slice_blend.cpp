#include "ultrasound/tissue/detail/slice_blend.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trocar::ultrasound::detail {
namespace {

/// Search distance of borders, in slice spacings and mm: assumed, a slope of about 1 in 3 is the flattest that differs
/// from an end.
constexpr double kReachSpacings = 3.0;
constexpr double kLeastBorderReach_mm = 6.0;
constexpr double kGreatestBorderReach_mm = 12.0;
/// Fraction of a structure's thickness: assumed distance of a missing border. A strip then continues by 0.45 of a slice
/// on average (1 - 0.5 ln 3), the mean extent of structures met by the slices.
constexpr float kEndShare = 0.25F;
/// Thicker structures have slopes, which look like ends if they are flat; they have a larger weight.
constexpr float kThin_mm = 6.0F;

float farthest_end_mm(float thickness_mm) {
  return kEndShare * thickness_mm * std::max(1.0F, thickness_mm / kThin_mm);
}

}  // namespace

SliceBlend::SliceBlend(const TissueVolume& volume) : volume_(volume) {
  const Vec3& spacing_mm = volume.geometry.spacing_mm;
  half_pixel_mm_ = static_cast<float>(0.25 * (spacing_mm[0] + spacing_mm[1]));
  reach_mm_ =
      static_cast<float>(std::clamp(kReachSpacings * spacing_mm[2], kLeastBorderReach_mm, kGreatestBorderReach_mm));
  const auto reach_u = static_cast<std::int32_t>(reach_mm_ / spacing_mm[0]);
  const auto reach_v = static_cast<std::int32_t>(reach_mm_ / spacing_mm[1]);
  for (std::int32_t v = -reach_v; v <= reach_v; ++v) {
    for (std::int32_t u = -reach_u; u <= reach_u; ++u) {
      const auto mm = static_cast<float>(std::hypot(u * spacing_mm[0], v * spacing_mm[1]));
      if ((u != 0 || v != 0) && mm <= reach_mm_) offsets_.push_back({u, v, mm});
    }
  }
  std::stable_sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) { return a.mm < b.mm; });
}

void SliceBlend::set_slices(std::int64_t w) {
  lower_ = volume_.tissue_slice(w);
  upper_ = volume_.tissue_slice(std::min(w + 1, volume_.geometry.size[2] - 1));
  changes_.clear();
  const volume::Index3& size = volume_.geometry.size;
  std::size_t pixel = 0;
  for (std::int64_t v = 0; v < size[1]; ++v) {
    for (std::int64_t u = 0; u < size[0]; ++u, ++pixel) {
      if (lower_[pixel] != upper_[pixel]) changes_.push_back(find_change(u, v, pixel));
    }
  }
}

SliceBlend::Change SliceBlend::find_change(std::int64_t u, std::int64_t v, std::size_t pixel) const {
  const std::uint8_t lower = lower_[pixel];
  const std::uint8_t upper = upper_[pixel];
  Change change{static_cast<std::uint32_t>(pixel), 0.0F, 0.0F, upper, upper};
  // At the end of the body the skin decides (a smooth distance), and structures inside continue to it.
  if (lower == kNoTissue) return change;
  if (upper == kNoTissue) {
    change.leave = change.arrive = 2.0F;
    return change;
  }

  const Borders borders = find_borders(u, v, lower, upper);
  const float leave = borders.lower_depth / (borders.lower_depth + borders.upper_away);
  const float arrive = borders.lower_away / (borders.lower_away + borders.upper_depth);
  const bool has_between = borders.beside_lower == borders.beside_upper && borders.beside_lower != lower &&
                           borders.beside_lower != upper && borders.beside_lower != kNoTissue && leave < arrive;
  if (has_between) {
    change.leave = leave;
    change.arrive = arrive;
    change.between = borders.beside_lower;
    return change;
  }

  // A thin structure without a counterpart nearby ends between the slices, like the rounded edge of a rod or disc; a
  // distant one is different. Of two tissues, the thinner one determines the border.
  const float lower_mm = thickness_mm(lower_, u, v);
  const float upper_mm = thickness_mm(upper_, u, v);
  const float upper_away = std::min(borders.upper_away, farthest_end_mm(lower_mm));
  const float lower_away = std::min(borders.lower_away, farthest_end_mm(upper_mm));
  const float lower_leaves = borders.lower_depth / (borders.lower_depth + upper_away);
  const float upper_comes = lower_away / (lower_away + borders.upper_depth);
  const float lower_share = upper_mm * upper_mm / (lower_mm * lower_mm + upper_mm * upper_mm);
  change.leave = change.arrive = lower_share * lower_leaves + (1.0F - lower_share) * upper_comes;
  return change;
}

SliceBlend::Borders SliceBlend::find_borders(std::int64_t u, std::int64_t v, std::uint8_t lower,
                                             std::uint8_t upper) const {
  constexpr float kNotFound = -1.0F;
  Borders found{kNotFound, kNotFound, kNotFound, kNotFound, lower, upper};
  const volume::Index3& size = volume_.geometry.size;
  for (const Offset& offset : offsets_) {
    const std::int64_t at_u = u + offset.u;
    const std::int64_t at_v = v + offset.v;
    if (at_u < 0 || at_v < 0 || at_u >= size[0] || at_v >= size[1]) continue;
    const auto at = static_cast<std::size_t>(at_v * size[0] + at_u);
    if (found.lower_depth < 0.0F && lower_[at] != lower) {
      found.lower_depth = offset.mm;
      found.beside_lower = lower_[at];
    }
    if (found.upper_depth < 0.0F && upper_[at] != upper) {
      found.upper_depth = offset.mm;
      found.beside_upper = upper_[at];
    }
    if (found.lower_away < 0.0F && lower_[at] == upper) found.lower_away = offset.mm;
    if (found.upper_away < 0.0F && upper_[at] == lower) found.upper_away = offset.mm;
    if (found.lower_depth >= 0.0F && found.upper_depth >= 0.0F && found.lower_away >= 0.0F && found.upper_away >= 0.0F)
      break;
  }
  for (float* mm : {&found.lower_depth, &found.upper_depth, &found.lower_away, &found.upper_away})
    *mm = (*mm < 0.0F ? reach_mm_ : *mm) - half_pixel_mm_;
  return found;
}

/// Shortest path through the tissue of a pixel along rows, columns and diagonals; each side counts up to the reach.
float SliceBlend::thickness_mm(const std::uint8_t* tissue, std::int64_t u, std::int64_t v) const {
  const volume::Index3& size = volume_.geometry.size;
  const Vec3& spacing_mm = volume_.geometry.spacing_mm;
  const std::uint8_t own = tissue[v * size[0] + u];
  float thinnest = 2.0F * reach_mm_;
  for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
    const auto step_mm = static_cast<float>(std::hypot(du * spacing_mm[0], dv * spacing_mm[1]));
    const auto most = static_cast<int>(reach_mm_ / step_mm);
    int pixels = 1;
    for (const int sign : {-1, 1}) {
      for (int n = 1; n <= most; ++n, ++pixels) {
        const std::int64_t at_u = u + sign * n * du;
        const std::int64_t at_v = v + sign * n * dv;
        if (at_u < 0 || at_v < 0 || at_u >= size[0] || at_v >= size[1] || tissue[at_v * size[0] + at_u] != own) break;
      }
    }
    thinnest = std::min(thinnest, static_cast<float>(pixels) * step_mm);
  }
  return thinnest;
}

void SliceBlend::blend(double fraction, std::vector<std::uint8_t>& out) const {
  out.assign(lower_, lower_ + volume_.slice_size());
  const auto at = static_cast<float>(fraction);
  for (const Change& change : changes_) {
    if (at >= change.arrive)
      out[change.pixel] = change.upper;
    else if (at >= change.leave)
      out[change.pixel] = change.between;
  }
}

}  // namespace trocar::ultrasound::detail
