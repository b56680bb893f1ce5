#include "xray/contrast/duct_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.h"
#include "core/result.h"
#include "geometry/shapes.h"
#include "volume/centreline.h"
#include "volume/distance.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/detail/duct_ends.h"

namespace trocar::xray {
namespace {

constexpr double kLeastTree_mm3 = 5.0;
constexpr double kShortestPiece_mm = 0.3;  ///< Shorter pieces are left out.
constexpr double kLongest_mm = 2.6;        ///< Longer ends are several cells: a front in a cell is not resolved.
constexpr double kThinnest_mm = 0.2;       ///< Radius.
constexpr double kMostScaling = 2.5;       ///< Of a branch's radii.

/// Length of the part of a tube that the centreline leaves out at its end.
double end_length_mm(const volume::CentrelineTree& tree, const volume::CentrelineTree::Tip& tip, double sign) {
  const volume::CentrelineNode& node = tree.nodes[static_cast<std::size_t>(tip.node)];
  return sign * (tip.p_P - node.p_P).dot(node.tangent_P);
}

/// The cells of one tree of centrelines, added to all cells.
class CellMaker {
 public:
  CellMaker(const volume::CentrelineTree& tree, std::vector<DuctCell>& cells) : tree_(tree), cells_(cells) {}

  void add() {
    cell_at_.assign(tree_.nodes.size(), -1);
    const volume::CentrelineNode& root = tree_.nodes.front();
    const double before_mm = end_length_mm(tree_, tree_.tips.front(), -1.0);
    if (before_mm > kShortestPiece_mm) add_end(root.p_P - before_mm * root.tangent_P, root.p_P, root.radius_mm, -1);
    cell_at_[0] = before_mm > kShortestPiece_mm ? last() : -1;
    for (std::size_t n = 1; n < tree_.nodes.size(); ++n) add_node(n);
    for (std::size_t t = 1; t < tree_.tips.size(); ++t) add_tip(tree_.tips[t]);
  }

 private:
  int last() const { return static_cast<int>(cells_.size()) - 1; }

  void add_cell(const Vec3& a_P, const Vec3& b_P, double radius_a_mm, double radius_b_mm, int parent) {
    DuctCell cell;
    cell.a_P = a_P;
    cell.b_P = b_P;
    cell.radius_a_mm = std::max(radius_a_mm, kThinnest_mm);
    cell.radius_b_mm = std::max(radius_b_mm, kThinnest_mm);
    cell.parent = parent;
    cells_.push_back(cell);
  }

  /// The straight part at an end.
  void add_end(const Vec3& a_P, const Vec3& b_P, double radius_mm, int parent) {
    const auto count = static_cast<int>(std::ceil((b_P - a_P).norm() / kLongest_mm));
    for (int n = 0; n < count; ++n) {
      const Vec3 from_P = a_P + (b_P - a_P) * n / count, to_P = a_P + (b_P - a_P) * (n + 1) / count;
      add_cell(from_P, to_P, radius_mm, radius_mm, n == 0 ? parent : last());
    }
  }

  void add_node(std::size_t n) {
    const volume::CentrelineNode& node = tree_.nodes[n];
    const volume::CentrelineNode& before = tree_.nodes[static_cast<std::size_t>(node.parent)];
    int parent = cell_at_[static_cast<std::size_t>(node.parent)];
    // The first part of a branch lies in the tube that it leaves.
    if (node.is_within_parent || (node.p_P - before.p_P).norm() < 1e-6) {
      cell_at_[n] = parent;
      return;
    }
    // Branches at the first node of a tree without a cell there.
    if (parent < 0 && !cells_.empty() && first_ >= 0) parent = first_;
    const double radius_a_mm = before.is_within_parent ? node.radius_mm : before.radius_mm;
    add_cell(before.p_P, node.p_P, radius_a_mm, node.radius_mm, parent);
    if (parent < 0) first_ = last();
    cell_at_[n] = last();
  }

  void add_tip(const volume::CentrelineTree::Tip& tip) {
    const volume::CentrelineNode& node = tree_.nodes[static_cast<std::size_t>(tip.node)];
    const double after_mm = end_length_mm(tree_, tip, 1.0);
    const int parent = cell_at_[static_cast<std::size_t>(tip.node)];
    if (after_mm <= kShortestPiece_mm || parent < 0 || node.is_within_parent) return;
    add_end(node.p_P, node.p_P + after_mm * node.tangent_P, node.radius_mm, parent);
  }

  const volume::CentrelineTree& tree_;
  std::vector<DuctCell>& cells_;
  std::vector<int> cell_at_;  ///< Cell that ends at a node.
  int first_ = -1;
};

/// Index of the unbranched section of each cell.
std::vector<int> find_sections(const std::vector<DuctCell>& cells) {
  std::vector<int> children(cells.size(), 0);
  for (const DuctCell& cell : cells)
    if (cell.parent >= 0) ++children[static_cast<std::size_t>(cell.parent)];
  std::vector<int> section(cells.size());
  int count = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const int parent = cells[n].parent;
    const bool goes_on = parent >= 0 && children[static_cast<std::size_t>(parent)] == 1;
    section[n] = goes_on ? section[static_cast<std::size_t>(parent)] : count++;
  }
  return section;
}

/// Cell whose tube contains a point most deeply.
int nearest_cell(const std::vector<DuctCell>& cells, const Vec3& p_P, double& depth_mm) {
  int best = -1;
  depth_mm = -std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const DuctCell& cell = cells[n];
    const Segment axis{cell.a_P, cell.b_P};
    const double f = closest_fraction(axis, p_P);
    const double radius_mm = std::lerp(cell.radius_a_mm, cell.radius_b_mm, f);
    const double depth = radius_mm - (axis.at(f) - p_P).norm();
    if (!(depth > depth_mm)) continue;
    depth_mm = depth;
    best = static_cast<int>(n);
  }
  return best;
}

/// Scales the radii of each section so that it has the volume of its voxels, and then all to the volume of the mask.
void scale_to_voxels(const volume::MaskGrid& mask, DuctTree& tree) {
  std::vector<std::size_t> voxels;
  for (std::size_t n = 0; n < mask.voxels.size(); ++n)
    if (mask.voxels[n]) voxels.push_back(n);
  std::vector<int> owner(voxels.size());
  parallel_for(voxels.size(), 256, [&](std::size_t first, std::size_t last) {
    double depth_mm = 0.0;
    for (std::size_t n = first; n < last; ++n)
      owner[n] = nearest_cell(tree.cells, mask.geometry.centre_mm(mask.geometry.index_of(voxels[n])), depth_mm);
  });
  const std::vector<int> section = find_sections(tree.cells);
  std::vector<double> wanted(tree.cells.size(), 0.0), is(tree.cells.size(), 0.0);
  const double voxel_ml = mask.geometry.voxel_volume_mm3() / kMm3PerMl;
  for (const int cell : owner) wanted[static_cast<std::size_t>(section[static_cast<std::size_t>(cell)])] += voxel_ml;
  for (std::size_t n = 0; n < tree.cells.size(); ++n)
    is[static_cast<std::size_t>(section[n])] += tree.cells[n].volume_ml();
  const auto scale = [](DuctCell& cell, double factor) {
    cell.radius_a_mm *= factor;
    cell.radius_b_mm *= factor;
  };
  for (std::size_t n = 0; n < tree.cells.size(); ++n) {
    const auto s = static_cast<std::size_t>(section[n]);
    scale(tree.cells[n], std::clamp(std::sqrt(wanted[s] / is[s]), 1.0 / kMostScaling, kMostScaling));
  }
  const double rest = std::sqrt(static_cast<double>(voxels.size()) * voxel_ml / tree.volume_ml());
  for (DuctCell& cell : tree.cells) scale(cell, rest);
}

}  // namespace

double DuctCell::volume_ml() const {
  const double squares = radius_a_mm * radius_a_mm + radius_a_mm * radius_b_mm + radius_b_mm * radius_b_mm;
  return std::numbers::pi / 3.0 * length_mm() * squares / kMm3PerMl;
}

double DuctTree::volume_ml() const {
  double sum = 0.0;
  for (const DuctCell& cell : cells) sum += cell.volume_ml();
  return sum;
}

int DuctTree::find_cell(const Vec3& p_P, double within_mm) const {
  if (!p_P.allFinite()) return -1;
  double depth_mm = 0.0;
  const int cell = nearest_cell(cells, p_P, depth_mm);
  return depth_mm >= -within_mm ? cell : -1;
}

DuctTree make_duct_tree(const anatomy::VirtualPatient& patient, const DuctTreeOptions& options) {
  TROCAR_CHECK(options.finest_mm >= 0.3 && options.finest_mm <= 3.0);
  TROCAR_CHECK(options.bridge_mm >= 0.0 && options.bridge_mm <= 20.0);
  DuctTree tree;
  const volume::MaskGrid mask = detail::make_duct_mask(patient, options.bridge_mm, options.finest_mm);
  if (mask.empty()) return tree;
  volume::FloatGrid depth_mm = volume::signed_distance_mm(mask);
  for (float& depth : depth_mm.voxels) depth = -depth;
  const std::vector<volume::CentrelineTree> centrelines = volume::find_centrelines(depth_mm, kLeastTree_mm3);
  for (const volume::CentrelineTree& part : centrelines) CellMaker(part, tree.cells).add();
  if (tree.cells.empty()) return tree;
  scale_to_voxels(mask, tree);
  detail::find_duct_ends(patient, options.encased_share, tree);
  return tree;
}

}  // namespace trocar::xray
