#include "patient_builder/plausibility/detail/edge_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace trocar::patient_builder::detail {
namespace {

constexpr std::size_t kMostEdges = 6'000, kMostOfOne = 600;
constexpr std::size_t kMostVisited = 6'000'000;  ///< Voxels that are looked at, evenly spread.
constexpr double kReach_mm = 3.0;
// Between fat and enhanced organs: what lies beyond, gas or bone, must not outweigh all other borders.
constexpr int kLeastHu = -150, kMostHu = 250;
constexpr std::array<std::string_view, 9> kJudged{"liver", "spleen", "kidney",      "organ",       "bone",
                                                  "lung",  "vessel", "gallbladder", "liver_lesion"};

/// So many of them, evenly spread.
template <class T>
void thin_out(std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return;
  for (std::size_t n = 0; n < most; ++n) all[n] = all[n * all.size() / most];
  all.resize(most);
}

}  // namespace

EdgeMatch::EdgeMatch(const volume::CtGrid& ct, const volume::LabelGrid& labels, const anatomy::LabelTable& table)
    : ct_(ct) {
  const volume::GridGeometry& g = labels.geometry;
  for (std::size_t axis = 0; axis < 3; ++axis)
    reach_[axis] = std::max<std::int64_t>(1, std::lround(kReach_mm / g.spacing_mm[static_cast<Eigen::Index>(axis)]));
  std::array<bool, 256> is_judged{}, occurs{};
  for (const anatomy::Label& label : table.labels)
    is_judged[label.id] = !label.is_derived && std::ranges::find(kJudged, label.tissue) != kJudged.end();
  const std::array<std::size_t, 3> step{1, static_cast<std::size_t>(g.size[0]),
                                        static_cast<std::size_t>(g.size[0] * g.size[1])};
  const std::size_t stride = std::max<std::size_t>(1, labels.voxels.size() / kMostVisited) | 1;
  for (std::size_t n = 0; n < labels.voxels.size(); n += stride) {
    const volume::Index3 ijk = g.index_of(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (ijk[axis] + 1 >= g.size[axis]) continue;
      const std::uint8_t here = labels.voxels[n], next = labels.voxels[n + step[axis]];
      if (here == next || !(is_judged[here] || is_judged[next])) continue;
      occurs[here] = occurs[next] = true;
      edges_.push_back({ijk, static_cast<int>(axis)});
      for (const std::uint8_t id : {here, next})
        if (is_judged[id]) edges_of_[id].push_back(edges_.back());
    }
  }
  for (std::size_t id = 0; id < 256; ++id) structures_ += is_judged[id] && occurs[id] ? 1 : 0;
  thin_out(edges_, kMostEdges);
  for (std::vector<Edge>& edges : edges_of_) thin_out(edges, kMostOfOne);
}

double EdgeMatch::step_at(volume::Index3 low, int axis, const volume::Index3& shift) const noexcept {
  const auto a = static_cast<std::size_t>(axis);
  for (std::size_t n = 0; n < 3; ++n) low[n] += shift[n];
  volume::Index3 before = low, behind = low;
  before[a] -= reach_[a] - 1;
  behind[a] += reach_[a];
  if (!ct_.geometry.contains(before) || !ct_.geometry.contains(behind)) return 0.0;
  const auto clamped = [&](const volume::Index3& ijk) { return std::clamp<int>(ct_[ijk], kLeastHu, kMostHu); };
  return std::abs(clamped(behind) - clamped(before));
}

double EdgeMatch::mean_step(const std::vector<Edge>& edges, const volume::Index3& shift,
                            const Reversal& reversed) const noexcept {
  double sum = 0.0;
  for (Edge edge : edges) {
    // Along its axis the border lies between the same two voxels, counted from the other end.
    for (std::size_t a = 0; a < 3; ++a)
      if (reversed[a])
        edge.low[a] = ct_.geometry.size[a] - 1 - edge.low[a] - (edge.axis == static_cast<int>(a) ? 1 : 0);
    sum += step_at(edge.low, edge.axis, shift);
  }
  return edges.empty() ? 0.0 : sum / static_cast<double>(edges.size());
}

}  // namespace trocar::patient_builder::detail
