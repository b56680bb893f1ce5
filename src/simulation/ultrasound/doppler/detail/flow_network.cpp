#include "ultrasound/doppler/detail/flow_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trocar::ultrasound::detail {
namespace {

constexpr double kTouches_mm = 6.0;  ///< A tip within this distance of a structure ends there. Assumed, range 3..10.

struct Reach {
  std::vector<std::vector<double>> distance_mm;  ///< Distance of each tip of each tree from the named structures.
  bool has_any = false;
};

/// Distances of the tips from the nearest voxel of the labels in `near`.
Reach find_reach(const anatomy::VirtualPatient& patient, std::uint8_t label, const FlowRule& rule,
                 const std::vector<volume::CentrelineTree>& trees) {
  Reach reach;
  for (const volume::CentrelineTree& tree : trees)
    reach.distance_mm.emplace_back(tree.tips.size(), std::numeric_limits<double>::infinity());
  std::array<bool, 256> is_near{};
  for (const anatomy::Label& other : patient.label_table.labels)
    is_near[other.id] = other.id != label && is_named(other.name, rule.near);
  const volume::GridGeometry& geometry = patient.labels.geometry;
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    if (!is_near[patient.labels.voxels[n]]) continue;
    reach.has_any = true;
    const volume::Index3 at = geometry.index_of(n);
    const Vec3 p_P = geometry.centre_mm(at);
    for (std::size_t t = 0; t < trees.size(); ++t)
      for (std::size_t e = 0; e < trees[t].tips.size(); ++e) {
        double& least = reach.distance_mm[t][e];
        least = std::min(least, (p_P - trees[t].tips[e].p_P).squaredNorm());
      }
  }
  for (auto& row : reach.distance_mm)
    for (double& distance : row) distance = std::sqrt(distance);
  return reach;
}

/// Length of the path between two nodes through their common ancestor.
double way_mm(const volume::CentrelineTree& tree, int from, int to) {
  double sum = 0.0;
  while (from != to) {
    int& later = from > to ? from : to;
    const volume::CentrelineNode& node = tree.nodes[static_cast<std::size_t>(later)];
    sum += (node.p_P - tree.nodes[static_cast<std::size_t>(node.parent)].p_P).norm();
    later = node.parent;
  }
  return sum;
}

/// The tip at the head: the one farthest from the most caudal one, with the sum of distance along the vessels and
/// height, so that the arch of the aorta has no influence; wide tips have a larger weight, to exclude winding branches.
/// At the feet: reversed.
std::vector<bool> tip_at(const volume::CentrelineTree& tree, FlowRule::At at) {
  const double sign = at == FlowRule::At::kHead ? 1.0 : -1.0;
  const auto opposite =
      std::min_element(tree.tips.begin(), tree.tips.end(),
                       [&](const volume::CentrelineTree::Tip& a, const volume::CentrelineTree::Tip& b) {
                         return sign * a.p_P.z() < sign * b.p_P.z();
                       });
  std::size_t farthest = 0;
  double best = -1.0;
  for (std::size_t e = 0; e < tree.tips.size(); ++e) {
    const double height_mm = sign * (tree.tips[e].p_P.z() - opposite->p_P.z());
    const double score = (way_mm(tree, tree.tips[e].node, opposite->node) + height_mm) * tree.tips[e].radius_mm;
    if (score > best) {
      best = score;
      farthest = e;
    }
  }
  std::vector<bool> is_named_end(tree.tips.size(), false);
  is_named_end[farthest] = true;
  return is_named_end;
}

/// Tips that touch the named labels; otherwise the nearest; if all touch, all but the widest.
std::vector<bool> tips_near(const volume::CentrelineTree& tree, const std::vector<double>& distance_mm) {
  std::vector<bool> is_named_end;
  for (const double distance : distance_mm) is_named_end.push_back(distance <= kTouches_mm);
  const auto count = std::count(is_named_end.begin(), is_named_end.end(), true);
  if (count == 0) {
    const auto nearest = std::min_element(distance_mm.begin(), distance_mm.end());
    is_named_end[static_cast<std::size_t>(nearest - distance_mm.begin())] = true;
  }
  if (count == static_cast<std::ptrdiff_t>(tree.tips.size())) {
    const auto widest =
        std::max_element(tree.tips.begin(), tree.tips.end(),
                         [](const volume::CentrelineTree::Tip& a, const volume::CentrelineTree::Tip& b) {
                           return a.radius_mm < b.radius_mm;
                         });
    is_named_end[static_cast<std::size_t>(widest - tree.tips.begin())] = false;
  }
  return is_named_end;
}

}  // namespace

std::vector<std::vector<bool>> find_sources(const anatomy::VirtualPatient& patient, std::uint8_t label,
                                            const FlowRule& rule, const std::vector<volume::CentrelineTree>& trees) {
  const Reach reach = find_reach(patient, label, rule, trees);
  const bool named_are_sources = rule.ends == FlowRule::End::kSources;
  std::vector<std::vector<bool>> sources;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    std::vector<bool> is_source = reach.has_any ? tips_near(trees[t], reach.distance_mm[t]) : tip_at(trees[t], rule.at);
    if (!named_are_sources) is_source.flip();
    sources.push_back(std::move(is_source));
  }
  return sources;
}

std::vector<bool> flows_from_root(const volume::CentrelineTree& tree, const std::vector<bool>& is_source) {
  double given = 0.0;
  double taken = 0.0;
  for (std::size_t e = 0; e < tree.tips.size(); ++e)
    (is_source[e] ? given : taken) += std::pow(tree.tips[e].radius_mm, 3);
  // Flow from the part beyond a node into the rest.
  std::vector<double> net(tree.nodes.size(), 0.0);
  for (std::size_t e = 0; e < tree.tips.size(); ++e) {
    const double volume = std::pow(tree.tips[e].radius_mm, 3);
    net[static_cast<std::size_t>(tree.tips[e].node)] += is_source[e] ? volume / given : -volume / taken;
  }
  for (std::size_t n = tree.nodes.size() - 1; n > 0; --n) net[static_cast<std::size_t>(tree.nodes[n].parent)] += net[n];
  std::vector<bool> from_root(tree.nodes.size());
  for (std::size_t n = 1; n < tree.nodes.size(); ++n) from_root[n] = net[n] < 0.0;
  from_root[0] = is_source[0];
  return from_root;
}

}  // namespace trocar::ultrasound::detail
