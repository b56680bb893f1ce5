// A CT that is cropped inside the body has no skin, to which depths are measured.
#include <fmt/format.h>

#include <algorithm>

#include "anatomy/plausibility/judge_anatomy.h"

namespace trocar::anatomy {
namespace {

constexpr double kMostlyInside = 0.5;  ///< Share of the sides from which on no task has a skin to enter.
constexpr double kTold = 0.1;          ///< Arms and hips are often beyond the edge of a CT.

/// Calls visit(offset) for the outermost voxels along i and j.
template <class Visit>
void for_each_at_sides(const volume::GridGeometry& g, const Visit& visit) {
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t j = 0; j < g.size[1]; ++j) {
      const bool is_edge_row = j == 0 || j == g.size[1] - 1;
      const std::int64_t step = is_edge_row ? 1 : std::max<std::int64_t>(1, g.size[0] - 1);
      for (std::int64_t i = 0; i < g.size[0]; i += step) visit(g.offset({i, j, k}));
    }
}

}  // namespace

std::vector<AnatomyFinding> judge_sides(const volume::MaskGrid& body) {
  std::size_t all = 0, inside = 0;
  for_each_at_sides(body.geometry, [&](std::size_t n) {
    ++all;
    inside += body.voxels[n];
  });
  const double share = all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
  if (share < kTold) return {};
  const std::string text =
      fmt::format("{:.0f} % of the sides of the CT lie inside the body: there it shows no skin", 100.0 * share);
  return {{kCropped, text,
           fmt::format("give a CT that shows the skin; --confirm {} takes the sides of the CT as the skin", kCropped),
           share >= kMostlyInside}};
}

void take_sides_as_skin(volume::MaskGrid& body) {
  for_each_at_sides(body.geometry, [&](std::size_t n) { body.voxels[n] = 0; });
}

AirIn air_of(const std::vector<std::string>& confirmed) {
  return std::ranges::find(confirmed, kCropped) != confirmed.end() ? AirIn::kNowhere : AirIn::kAroundTheBody;
}

}  // namespace trocar::anatomy
