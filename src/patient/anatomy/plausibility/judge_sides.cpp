// A CT that is cropped inside the body has no skin, to which depths are measured.
#include <fmt/format.h>

#include <algorithm>

#include "anatomy/plausibility/judge_anatomy.h"

namespace trocar::anatomy {
namespace {

constexpr double kMostlyInside = 0.5;  ///< Share of every side from which on no task has a skin to enter.
constexpr double kTold = 0.1;          ///< Of all sides: arms and hips are often beyond the edge of a CT.

/// Calls visit(offset) for the outermost voxels of one side: the lowest or highest i or j.
template <class Visit>
void for_each_at_side(const volume::GridGeometry& g, std::size_t axis, bool is_high, const Visit& visit) {
  const std::size_t other = 1 - axis;
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t n = 0; n < g.size[other]; ++n) {
      volume::Index3 ijk{0, 0, k};
      ijk[axis] = is_high ? g.size[axis] - 1 : 0;
      ijk[other] = n;
      visit(g.offset(ijk));
    }
}

}  // namespace

std::vector<AnatomyFinding> judge_sides(const volume::MaskGrid& body) {
  double all = 0.0, inside = 0.0, least_share = 1.0;
  for (const std::size_t axis : {0U, 1U})
    for (const bool is_high : {false, true}) {
      double of_side = 0.0, inside_of_side = 0.0;
      for_each_at_side(body.geometry, axis, is_high, [&](std::size_t n) {
        of_side += 1.0;
        inside_of_side += body.voxels[n];
      });
      all += of_side;
      inside += inside_of_side;
      least_share = std::min(least_share, inside_of_side / std::max(of_side, 1.0));
    }
  const double share = inside / std::max(all, 1.0);
  if (share < kTold) return {};
  const std::string text =
      fmt::format("{:.0f} % of the sides of the CT lie inside the body: there it shows no skin", 100.0 * share);
  return {{kCropped, text,
           fmt::format("give a CT that shows the skin; --confirm {} takes the sides of the CT as the skin", kCropped),
           least_share >= kMostlyInside}};
}

void take_sides_as_skin(volume::MaskGrid& body) {
  for (const std::size_t axis : {0U, 1U})
    for (const bool is_high : {false, true})
      for_each_at_side(body.geometry, axis, is_high, [&](std::size_t n) { body.voxels[n] = 0; });
}

AirIn air_of(const std::vector<std::string>& confirmed) {
  return std::ranges::find(confirmed, kCropped) != confirmed.end() ? AirIn::kNowhere : AirIn::kAroundTheBody;
}

}  // namespace trocar::anatomy
