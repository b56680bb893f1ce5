#include "volume/centreline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>

namespace trocar::volume {
namespace {

constexpr float kUnreached = std::numeric_limits<float>::infinity();
constexpr double kLeastDepth_mm = 0.2;   ///< Lower limit for the cost of voxels at the wall.
constexpr double kCovers = 1.3;          ///< Radius of the region covered by a path, in radii,
constexpr double kCoversMore_mm = 1.5;   ///< plus this length.
constexpr double kLeastBranch_mm = 4.0;  ///< Branches that protrude less than this, or
constexpr double kBulge = 1.0;           ///< less than this many of its neighbour's radii, are bulges.
constexpr double kSmoothing = 0.6;       ///< Radii; standard deviation of the smoothing.
constexpr double kLeastSmoothing_mm = 1.5;
constexpr double kMostSmoothing_mm = 7.0;
constexpr double kEndReach = 3.0;    ///< Radii.
constexpr double kEndLeftOut = 1.6;  ///< Radii; a path from a corner to the centre is longer than one.
constexpr std::size_t kTipNodes = 12;

/// One step to a neighbouring voxel.
struct Step {
  std::int64_t di, dj, dk;
  std::int64_t offset;
  float length_mm;
};

std::vector<Step> make_steps(const GridGeometry& geometry) {
  std::vector<Step> steps;
  for (std::int64_t k = -1; k <= 1; ++k)
    for (std::int64_t j = -1; j <= 1; ++j)
      for (std::int64_t i = -1; i <= 1; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        const Vec3 way(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        steps.push_back({i, j, k, (k * geometry.size[1] + j) * geometry.size[0] + i,
                         static_cast<float>(way.cwiseProduct(geometry.spacing_mm).norm())});
      }
  return steps;
}

/// A voxel on its path to the root.
struct RawNode {
  std::size_t voxel;
  int parent;       ///< Raw node.
  double reach_mm;  ///< Radius of the tube: at its ends that of the last full section.
};

struct Branch {
  std::vector<int> nodes;  ///< Raw nodes from the parent's node (the root: its own) to its end.
};

class Finder {
 public:
  explicit Finder(const FloatGrid& depth_mm)
      : depth_(depth_mm), geometry_(depth_mm.geometry), steps_(make_steps(geometry_)) {
    const std::size_t n = depth_.voxels.size();
    way_.assign(n, kUnreached);
    cost_.assign(n, kUnreached);
    before_.assign(n, 0);
    state_.assign(n, kUnseen);
    for (std::size_t v = 0; v < n; ++v)
      if (!(depth_.voxels[v] > 0.0F)) state_[v] = kOutside;
  }

  std::vector<CentrelineTree> run(double least_mm3) {
    std::vector<CentrelineTree> trees;
    for (std::size_t v = 0; v < state_.size(); ++v) {
      if (state_[v] != kUnseen) continue;
      const std::vector<std::size_t> piece = spread(v, way_, false);
      for (const std::size_t member : piece) state_[member] = kSeen;
      if (static_cast<double>(piece.size()) * geometry_.voxel_volume_mm3() < least_mm3) continue;
      CentrelineTree tree = make_tree(piece);
      if (tree.nodes.size() >= 3) trees.push_back(std::move(tree));
    }
    return trees;
  }

 private:
  enum State : std::uint8_t { kOutside, kUnseen, kSeen, kCovered };

  /// Dijkstra from a voxel through its component; returns the voxels by increasing distance. With costs, `before_`
  /// contains the predecessors.
  std::vector<std::size_t> spread(std::size_t from, std::vector<float>& distance, bool is_cost) {
    using Entry = std::pair<float, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<std::size_t> order;
    distance[from] = 0.0F;
    before_[from] = from;
    queue.emplace(0.0F, from);
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (so_far > distance[v]) continue;
      order.push_back(v);
      const Index3 at = geometry_.index_of(v);
      for (const Step& step : steps_) {
        if (!geometry_.contains({at[0] + step.di, at[1] + step.dj, at[2] + step.dk})) continue;
        const auto to = static_cast<std::size_t>(static_cast<std::int64_t>(v) + step.offset);
        if (state_[to] == kOutside) continue;
        const float next = so_far + step.length_mm * (is_cost ? price(to) : 1.0F);
        if (!(next < distance[to])) continue;
        distance[to] = next;
        before_[to] = v;
        queue.emplace(next, to);
      }
    }
    return order;
  }

  float price(std::size_t v) const {
    const float depth = std::max(depth_.voxels[v], static_cast<float>(kLeastDepth_mm));
    return 1.0F / (depth * depth * depth);
  }

  /// The voxel of the component farthest from any other voxel is at one end.
  CentrelineTree make_tree(const std::vector<std::size_t>& piece) {
    const std::size_t root = piece.back();
    for (const std::size_t v : piece) way_[v] = kUnreached;
    const std::vector<std::size_t> by_way = spread(root, way_, false);
    spread(root, cost_, true);
    raw_ = {{root, -1, depth_mm(root)}};
    node_of_.clear();
    node_of_[root] = 0;
    branches_.clear();
    for (auto it = by_way.rbegin(); it != by_way.rend(); ++it)
      if (state_[*it] == kSeen) add_path(*it);
    return smoothed();
  }

  void add_path(std::size_t tip) {
    std::vector<std::size_t> path;
    std::size_t v = tip;
    for (; !node_of_.contains(v); v = before_[v]) path.push_back(v);
    const bool is_first = branches_.empty();
    if (!is_first && !stands_out(tip)) {
      for (const std::size_t member : path) cover(member, depth_mm(member));
      return;
    }
    Branch branch{{node_of_.at(v)}};
    for (auto it = path.rbegin(); it != path.rend(); ++it) {
      raw_.push_back({*it, branch.nodes.back(), depth_mm(*it)});
      node_of_[*it] = static_cast<int>(raw_.size()) - 1;
      branch.nodes.push_back(static_cast<int>(raw_.size()) - 1);
    }
    widen_end(branch.nodes);
    if (is_first) widen_end({branch.nodes.rbegin(), branch.nodes.rend()});
    for (const int node : branch.nodes) {
      const RawNode& raw = raw_[static_cast<std::size_t>(node)];
      cover(raw.voxel, raw.reach_mm);
    }
    branches_.push_back(std::move(branch));
  }

  /// The path into a corner of the tube's end represents the whole end.
  void widen_end(const std::vector<int>& nodes) {
    const std::size_t full = kept(nodes) - 1;
    const double radius_mm = raw_[static_cast<std::size_t>(nodes[full])].reach_mm;
    for (std::size_t n = full; n < nodes.size(); ++n) {
      double& reach_mm = raw_[static_cast<std::size_t>(nodes[n])].reach_mm;
      reach_mm = std::max(reach_mm, radius_mm);
    }
  }

  double depth_mm(std::size_t v) const { return static_cast<double>(depth_.voxels[v]); }
  Vec3 place(std::size_t v) const {
    const Index3 at = geometry_.index_of(v);
    return geometry_.centre_mm(at);
  }
  /// True if a point is clearly outside the balls around all nodes.
  bool stands_out(std::size_t tip) const {
    const Vec3 p = place(tip);
    return std::all_of(raw_.begin(), raw_.end(), [&](const RawNode& node) {
      return (place(node.voxel) - p).norm() - node.reach_mm > std::max(kLeastBranch_mm, kBulge * node.reach_mm);
    });
  }

  /// Voxels near a path need no separate path.
  void cover(std::size_t middle, double radius_mm) {
    const double reach_mm = kCovers * radius_mm + kCoversMore_mm;
    const Index3 at = geometry_.index_of(middle);
    Index3 low, high;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto reach = static_cast<std::int64_t>(reach_mm / geometry_.spacing_mm[static_cast<Eigen::Index>(a)]);
      low[a] = std::max<std::int64_t>(at[a] - reach, 0);
      high[a] = std::min(at[a] + reach, geometry_.size[a] - 1);
    }
    const Vec3 p = place(middle);
    for (std::int64_t k = low[2]; k <= high[2]; ++k)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t i = low[0]; i <= high[0]; ++i) {
          const std::size_t v = geometry_.offset({i, j, k});
          if (state_[v] == kSeen && (place(v) - p).norm() <= reach_mm) state_[v] = kCovered;
        }
  }

  /// Number of nodes of a branch that are farther from the tube's end than its radius there: paths start in corners. At
  /// least half of them.
  std::size_t kept(const std::vector<int>& nodes) const {
    const auto voxel = [&](std::size_t n) { return raw_[static_cast<std::size_t>(nodes[n])].voxel; };
    const auto step_mm = [&](std::size_t n) { return (place(voxel(n)) - place(voxel(n - 1))).norm(); };
    const std::size_t half = nodes.size() / 2;
    // Radius of balls that extend to the end or nearly to it.
    double radius_mm = 0.0;
    double from_end_mm = 0.0;
    for (std::size_t n = nodes.size() - 1; n > half; from_end_mm += step_mm(n), --n)
      if (from_end_mm <= kEndReach * depth_mm(voxel(n))) radius_mm = std::max(radius_mm, depth_mm(voxel(n)));
    std::size_t count = nodes.size();
    from_end_mm = 0.0;
    for (std::size_t n = nodes.size() - 1; n > half && from_end_mm < kEndLeftOut * radius_mm; --n) {
      count = n;
      from_end_mm += step_mm(n);
    }
    return count;
  }

  CentrelineTree smoothed() {
    CentrelineTree tree;
    std::vector<int> index(raw_.size(), -1);  // raw node -> node of the tree
    for (std::size_t b = 0; b < branches_.size(); ++b) {
      std::vector<int> nodes = branches_[b].nodes;
      const Vec3 end_P = place(raw_[static_cast<std::size_t>(nodes.back())].voxel);
      const Vec3 root_P = place(raw_[static_cast<std::size_t>(nodes.front())].voxel);
      nodes.resize(kept(nodes));
      std::size_t first = 0;
      if (b == 0) {
        std::vector<int> backwards(nodes.rbegin(), nodes.rend());
        first = nodes.size() - kept(backwards);
        // Branches from the removed end are attached to the first node.
        for (std::size_t n = 0; n <= first; ++n) index[static_cast<std::size_t>(nodes[n])] = 0;
      }
      nodes.erase(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(first));
      add_nodes(nodes, b == 0, index, tree);
      // Branches from the removed end are attached to the last node.
      for (const int raw : branches_[b].nodes)
        if (index[static_cast<std::size_t>(raw)] < 0)
          index[static_cast<std::size_t>(raw)] = static_cast<int>(tree.nodes.size()) - 1;
      if (b == 0) tree.tips.push_back({0, root_P, 0.0});
      tree.tips.push_back({static_cast<int>(tree.nodes.size()) - 1, end_P, 0.0});
    }
    for (CentrelineTree::Tip& tip : tree.tips) tip.radius_mm = tip_radius(tree, tip.node);
    return tree;
  }

  static double tip_radius(const CentrelineTree& tree, int node) {
    double sum = 0.0;
    double count = 0.0;
    if (node == 0) {
      for (std::size_t n = 0; n < std::min(kTipNodes, tree.nodes.size()); ++n, ++count) sum += tree.nodes[n].radius_mm;
      return sum / count;
    }
    for (std::size_t n = 0; n < kTipNodes && node >= 0; ++n, ++count) {
      const CentrelineNode& at = tree.nodes[static_cast<std::size_t>(node)];
      if (at.is_within_parent && count > 0.0) break;
      sum += at.radius_mm;
      node = at.parent;
    }
    return sum / count;
  }

  /// Smooths one branch (raw nodes, from its parent's node) and adds it.
  void add_nodes(const std::vector<int>& nodes, bool is_first, std::vector<int>& index, CentrelineTree& tree) const {
    std::vector<Vec3> points;
    std::vector<double> along{0.0};
    std::vector<double> depths;
    for (const int raw : nodes) {
      const std::size_t v = raw_[static_cast<std::size_t>(raw)].voxel;
      points.push_back(place(v));
      depths.push_back(depth_mm(v));
      if (points.size() > 1) along.push_back(along.back() + (points.back() - points[points.size() - 2]).norm());
    }
    int parent = is_first ? -1 : index[static_cast<std::size_t>(nodes.front())];
    const double parent_radius_mm = is_first ? 0.0 : depths.front();
    for (std::size_t n = is_first ? 0 : 1; n < nodes.size(); ++n) {
      CentrelineNode node = fitted(points, along, depths, n);
      node.parent = parent;
      node.is_within_parent = along[n] < parent_radius_mm;
      parent = static_cast<int>(tree.nodes.size());
      index[static_cast<std::size_t>(nodes[n])] = parent;
      tree.nodes.push_back(node);
    }
  }

  /// The least squares line through a neighbourhood: position and direction.
  static CentrelineNode fitted(std::span<const Vec3> points, std::span<const double> along,
                               std::span<const double> depths, std::size_t at) {
    const double sigma = std::clamp(kSmoothing * depths[at], kLeastSmoothing_mm, kMostSmoothing_mm);
    double w_sum = 0.0, s_sum = 0.0, ss_sum = 0.0, r_sum = 0.0;
    Vec3 p_sum = Vec3::Zero();
    Vec3 sp_sum = Vec3::Zero();
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double s = along[n] - along[at];
      if (std::abs(s) > 3.0 * sigma) continue;
      const double w = std::exp(-0.5 * s * s / (sigma * sigma));
      w_sum += w;
      s_sum += w * s;
      ss_sum += w * s * s;
      p_sum += w * points[n];
      sp_sum += w * s * points[n];
      r_sum += w * depths[n];
    }
    const double spread = w_sum * ss_sum - s_sum * s_sum;
    CentrelineNode node;
    node.radius_mm = r_sum / w_sum;
    node.p_P = p_sum / w_sum;
    if (!(spread > 1e-9)) return node;
    const Vec3 slope = (w_sum * sp_sum - s_sum * p_sum) / spread;
    node.p_P = (p_sum - s_sum * slope) / w_sum;
    if (slope.norm() > 1e-9) node.tangent_P = slope.normalized();
    return node;
  }

  const FloatGrid& depth_;
  const GridGeometry& geometry_;
  std::vector<Step> steps_;
  std::vector<float> way_, cost_;
  std::vector<std::size_t> before_;
  std::vector<std::uint8_t> state_;
  std::vector<RawNode> raw_;
  std::unordered_map<std::size_t, int> node_of_;
  std::vector<Branch> branches_;
};

}  // namespace

std::vector<CentrelineTree> find_centrelines(const FloatGrid& depth_mm, double least_mm3) {
  return Finder(depth_mm).run(least_mm3);
}

}  // namespace trocar::volume
