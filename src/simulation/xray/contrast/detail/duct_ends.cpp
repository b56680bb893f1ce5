#include "xray/contrast/detail/duct_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <vector>

#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::xray::detail {
namespace {

constexpr double kBeyondWall_mm = 2.0;  ///< Where a ring around a duct looks for a lesion.
constexpr double kRings_mm = 0.5;       ///< The ring also looks this much nearer and farther, per voxel.
constexpr int kRingDirections = 16;
constexpr double kEndReach_mm = 4.0;  ///< From an end to the bowel or to a stretch.
constexpr double kNarrow = 0.6;       ///< Of the widest radius beside it: a narrow place.
constexpr double kEndRadii = 2.0;     ///< An end as near to a lesion as that, in its radii, is closed by it.
constexpr int kNeighbourCells = 5;    ///< Beside a stretch.

/// What the labels around a duct say.
class Surroundings {
 public:
  explicit Surroundings(const anatomy::VirtualPatient& patient) : patient_(patient) {
    for (const anatomy::Label& label : patient.label_table.labels) {
      is_lesion_[label.id] = label.tissue.ends_with("_lesion");
      is_bowel_[label.id] = label.tissue == "bowel";
    }
  }

  /// Share of the directions around the middle of a cell in which a lesion begins behind the wall.
  double encased(const DuctCell& cell) const {
    const Vec3 along = (cell.b_P - cell.a_P).normalized();
    const Vec3 u = along.unitOrthogonal();
    const Vec3 v = along.cross(u);
    const Vec3 middle_P = 0.5 * (cell.a_P + cell.b_P);
    const double radius_mm = 0.5 * (cell.radius_a_mm + cell.radius_b_mm);
    const double voxel_mm = patient_.labels.geometry.spacing_mm.maxCoeff();
    int count = 0;
    for (int n = 0; n < kRingDirections; ++n) {
      const double angle = 2.0 * std::numbers::pi * n / kRingDirections;
      const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
      bool is_touched = false;
      for (const double more_mm : {-kRings_mm * voxel_mm, 0.0, kRings_mm * voxel_mm})
        is_touched = is_touched || is_lesion_[label(middle_P + (radius_mm + kBeyondWall_mm + more_mm) * out)];
      count += is_touched ? 1 : 0;
    }
    return static_cast<double>(count) / kRingDirections;
  }

  /// True if bowel is near the end of a duct, before it or beside it.
  bool touches_bowel(const Vec3& end_P, double radius_mm) const {
    const volume::GridGeometry& g = patient_.labels.geometry;
    const Vec3 index = g.to_index(end_P);
    const double reach_mm = radius_mm + kEndReach_mm;
    volume::Index3 low, high;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      const double reach = reach_mm / g.spacing_mm[axis];
      low[a] = std::max<std::int64_t>(std::llround(index[axis] - reach), 0);
      high[a] = std::min<std::int64_t>(std::llround(index[axis] + reach), g.size[a] - 1);
    }
    for (std::int64_t k = low[2]; k <= high[2]; ++k)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t i = low[0]; i <= high[0]; ++i)
          if (is_bowel_[patient_.labels[{i, j, k}]] && (g.centre_mm({i, j, k}) - end_P).norm() <= reach_mm) return true;
    return false;
  }

 private:
  std::uint8_t label(const Vec3& p_P) const { return volume::sample_nearest<std::uint8_t>(patient_.labels, p_P, 0); }

  const anatomy::VirtualPatient& patient_;
  std::array<bool, 256> is_lesion_{}, is_bowel_{};
};

/// The end of a cell, at b or, for the first cell of a tree, at a.
struct End {
  std::size_t cell;
  bool is_root;
  double radius_mm;
  Vec3 p_P;
};

std::vector<End> find_ends(const DuctTree& tree) {
  std::vector<bool> has_child(tree.cells.size(), false);
  for (const DuctCell& cell : tree.cells)
    if (cell.parent >= 0) has_child[static_cast<std::size_t>(cell.parent)] = true;
  std::vector<End> ends;
  for (std::size_t n = 0; n < tree.cells.size(); ++n) {
    const DuctCell& cell = tree.cells[n];
    if (!has_child[n]) ends.push_back({n, false, cell.radius_b_mm, cell.b_P});
    if (cell.parent < 0) ends.push_back({n, true, cell.radius_a_mm, cell.a_P});
  }
  return ends;
}

DuctEnd& kind_of(DuctTree& tree, const End& end) {
  DuctCell& cell = tree.cells[end.cell];
  return end.is_root ? cell.root_end : cell.end;
}

/// Stretch of encased cells of each cell; -1: not encased. Neighbouring encased cells belong to one stretch.
std::vector<int> find_stretches(const DuctTree& tree, const Surroundings& around, double encased_share) {
  std::vector<int> stretch(tree.cells.size(), -1);
  int count = 0;
  for (std::size_t n = 0; n < tree.cells.size(); ++n) {
    if (around.encased(tree.cells[n]) < encased_share) continue;
    const int parent = tree.cells[n].parent;
    const int before = parent >= 0 ? stretch[static_cast<std::size_t>(parent)] : -1;
    stretch[n] = before >= 0 ? before : count++;
  }
  return stretch;
}

/// Radius of the widest cell of a stretch and of the cells within a few steps of it.
double widest_mm(const DuctTree& tree, const std::vector<int>& stretch, int which) {
  std::vector<bool> is_near(tree.cells.size());
  for (std::size_t n = 0; n < is_near.size(); ++n) is_near[n] = stretch[n] == which;
  for (int step = 0; step < kNeighbourCells; ++step) {
    const std::vector<bool> before = is_near;
    for (std::size_t n = 0; n < is_near.size(); ++n) {
      if (tree.cells[n].parent < 0) continue;
      const auto parent = static_cast<std::size_t>(tree.cells[n].parent);
      if (before[parent]) is_near[n] = true;
      if (before[n]) is_near[parent] = true;
    }
  }
  double widest = 0.0;
  for (std::size_t n = 0; n < is_near.size(); ++n)
    if (is_near[n]) widest = std::max({widest, tree.cells[n].radius_a_mm, tree.cells[n].radius_b_mm});
  return widest;
}

/// Closes the narrowest place of a stretch if it is narrower than the duct beside it, and else the ends close to it:
/// the narrow rest of a wide duct may be shorter than its radius, and is then no branch of the tree.
void close_stretch(DuctTree& tree, const std::vector<int>& stretch, int which, const std::vector<End>& ends) {
  double narrowest_mm = std::numeric_limits<double>::infinity();
  int narrowest = -1;
  for (std::size_t n = 0; n < tree.cells.size(); ++n) {
    const DuctCell& cell = tree.cells[n];
    const double radius_mm = std::min(cell.radius_a_mm, cell.radius_b_mm);
    if (stretch[n] != which || cell.parent < 0 || radius_mm >= narrowest_mm) continue;
    narrowest = static_cast<int>(n);
    narrowest_mm = radius_mm;
  }
  if (narrowest >= 0 && narrowest_mm < kNarrow * widest_mm(tree, stretch, which)) {
    tree.cells[static_cast<std::size_t>(narrowest)].is_closed = true;
    return;
  }
  for (const End& end : ends)
    for (std::size_t n = 0; n < tree.cells.size(); ++n) {
      const bool is_close = (tree.cells[n].b_P - end.p_P).norm() <= kEndRadii * end.radius_mm + kEndReach_mm;
      if (stretch[n] == which && is_close) kind_of(tree, end) = DuctEnd::kObstructed;
    }
}

}  // namespace

void find_duct_ends(const anatomy::VirtualPatient& patient, double encased_share, DuctTree& tree) {
  const Surroundings around(patient);
  const std::vector<End> ends = find_ends(tree);
  for (const End& end : ends) kind_of(tree, end) = DuctEnd::kPeripheral;
  const std::vector<int> stretch = find_stretches(tree, around, encased_share);
  const int count = stretch.empty() ? 0 : *std::max_element(stretch.begin(), stretch.end()) + 1;
  for (int n = 0; n < count; ++n) close_stretch(tree, stretch, n, ends);
  const End* papilla = nullptr;
  for (const End& end : ends) {
    if (kind_of(tree, end) == DuctEnd::kObstructed || !around.touches_bowel(end.p_P, end.radius_mm)) continue;
    if (papilla == nullptr || end.radius_mm > papilla->radius_mm) papilla = &end;
  }
  if (papilla != nullptr) kind_of(tree, *papilla) = DuctEnd::kPapilla;
}

namespace {

constexpr std::int64_t kMargin = 3;  ///< Voxels around the ducts.
constexpr double kLeastPiece_mm3 = 20.0;
constexpr std::size_t kMostPieces = 100;  ///< Bridged ones; the rest is left out unless it touches.

/// Box of the ducts' voxels in the labels, as a mask.
volume::MaskGrid cut_ducts(const anatomy::VirtualPatient& patient) {
  std::array<bool, 256> is_duct{};
  bool has_any = false;
  for (const anatomy::Label& label : patient.label_table.labels)
    if (label.tissue == "bile_duct") has_any = is_duct[label.id] = true;
  if (!has_any) return {};
  const volume::GridGeometry& g = patient.labels.geometry;
  volume::Index3 low = g.size, high{-1, -1, -1};
  std::size_t n = 0;
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t j = 0; j < g.size[1]; ++j)
      for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
        if (!is_duct[patient.labels.voxels[n]]) continue;
        const volume::Index3 at{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], at[a]);
          high[a] = std::max(high[a], at[a]);
        }
      }
  if (high[0] < 0) return {};
  volume::GridGeometry box = g;
  for (std::size_t a = 0; a < 3; ++a) box.size[a] = high[a] - low[a] + 1 + 2 * kMargin;
  box.origin_P = g.to_mm(volume::to_vec3(low) - Vec3::Constant(static_cast<double>(kMargin)));
  volume::MaskGrid mask(box);
  for (n = 0; n < mask.voxels.size(); ++n) {
    volume::Index3 at = box.index_of(n);
    for (std::size_t a = 0; a < 3; ++a) at[a] += low[a] - kMargin;
    mask.voxels[n] = g.contains(at) && is_duct[patient.labels[at]] ? 1 : 0;
  }
  return mask;
}

/// Pieces of a mask, in which voxels that share a corner belong together.
struct Pieces {
  volume::Grid<std::int32_t> ids;  ///< 0 outside, else 1 + index of the piece.
  std::vector<std::vector<std::size_t>> voxels;
};

Pieces find_pieces(const volume::MaskGrid& mask) {
  const volume::GridGeometry& g = mask.geometry;
  Pieces pieces{volume::Grid<std::int32_t>(g), {}};
  for (std::size_t start = 0; start < mask.voxels.size(); ++start) {
    if (!mask.voxels[start] || pieces.ids.voxels[start] != 0) continue;
    std::vector<std::size_t> piece{start};
    const auto id = static_cast<std::int32_t>(pieces.voxels.size() + 1);
    pieces.ids.voxels[start] = id;
    for (std::size_t n = 0; n < piece.size(); ++n) {
      const volume::Index3 at = g.index_of(piece[n]);
      for (std::int64_t dk = -1; dk <= 1; ++dk)
        for (std::int64_t dj = -1; dj <= 1; ++dj)
          for (std::int64_t di = -1; di <= 1; ++di) {
            const volume::Index3 to{at[0] + di, at[1] + dj, at[2] + dk};
            if (!g.contains(to) || !mask[to] || pieces.ids[to] != 0) continue;
            pieces.ids[to] = id;
            piece.push_back(g.offset(to));
          }
    }
    pieces.voxels.push_back(std::move(piece));
  }
  std::stable_sort(pieces.voxels.begin(), pieces.voxels.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return pieces;
}

/// Marks the voxels on the line between two voxels.
void draw_line(volume::MaskGrid& mask, const volume::Index3& from, const volume::Index3& to) {
  std::int64_t steps = 1;
  for (std::size_t a = 0; a < 3; ++a) steps = std::max<std::int64_t>(steps, std::abs(to[a] - from[a]));
  for (std::int64_t n = 0; n <= steps; ++n) {
    volume::Index3 at;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = from[a] + std::llround(static_cast<double>((to[a] - from[a]) * n) / static_cast<double>(steps));
    mask[at] = 1;
  }
}

/// The voxel of `joined` nearest to a voxel, within a cube of `reach` voxels.
bool find_nearest(const volume::MaskGrid& joined, const volume::Index3& from, std::int64_t reach,
                  volume::Index3& nearest, double& best_mm) {
  bool is_found = false;
  const Vec3 p = volume::to_vec3(from);
  for (std::int64_t k = from[2] - reach; k <= from[2] + reach; ++k)
    for (std::int64_t j = from[1] - reach; j <= from[1] + reach; ++j)
      for (std::int64_t i = from[0] - reach; i <= from[0] + reach; ++i) {
        const volume::Index3 at{i, j, k};
        if (!joined.geometry.contains(at) || !joined[at]) continue;
        const double mm = (volume::to_vec3(at) - p).cwiseProduct(joined.geometry.spacing_mm).norm();
        if (mm >= best_mm) continue;
        best_mm = mm;
        nearest = at;
        is_found = true;
      }
  return is_found;
}

/// Joins a piece to the joined ones over the narrowest gap of at most `bridge_mm`.
bool join(volume::MaskGrid& joined, const std::vector<std::size_t>& piece, double bridge_mm) {
  const volume::GridGeometry& g = joined.geometry;
  const double spacing_mm = g.spacing_mm.minCoeff();
  const auto reach = static_cast<std::int64_t>((bridge_mm + spacing_mm) / spacing_mm);
  double best_mm = bridge_mm + spacing_mm;  // between centres of voxels
  volume::Index3 from{}, to{};
  bool is_found = false;
  for (const std::size_t n : piece) {
    const volume::Index3 at = g.index_of(n);
    if (!find_nearest(joined, at, reach, to, best_mm)) continue;
    from = at;
    is_found = true;
  }
  if (!is_found) return false;
  draw_line(joined, from, to);
  for (const std::size_t n : piece) joined.voxels[n] = 1;
  return true;
}

}  // namespace

volume::MaskGrid make_duct_mask(const anatomy::VirtualPatient& patient, double bridge_mm, double finest_mm) {
  const volume::MaskGrid cut = cut_ducts(patient);
  if (cut.empty()) return {};
  const double spacing_mm = std::max(cut.geometry.spacing_mm.minCoeff(), finest_mm);
  volume::MaskGrid mask(volume::isotropic_geometry(cut.geometry, spacing_mm));
  for (std::size_t n = 0; n < mask.voxels.size(); ++n)
    mask.voxels[n] = volume::sample_nearest<std::uint8_t>(cut, mask.geometry.centre_mm(mask.geometry.index_of(n)), 0);
  const Pieces pieces = find_pieces(mask);
  if (pieces.voxels.empty()) return {};
  volume::MaskGrid joined(mask.geometry);
  for (const std::size_t n : pieces.voxels.front()) joined.voxels[n] = 1;
  // A piece may reach the joined ones only through another piece.
  std::vector<std::size_t> waiting;
  for (std::size_t n = 1; n < std::min(pieces.voxels.size(), kMostPieces); ++n) waiting.push_back(n);
  for (bool has_changed = true; has_changed && bridge_mm > 0.0;) {
    const auto joins = [&](std::size_t n) { return join(joined, pieces.voxels[n], bridge_mm); };
    has_changed = std::erase_if(waiting, joins) > 0;
  }
  const double least = kLeastPiece_mm3 / mask.geometry.voxel_volume_mm3();
  for (const std::size_t n : waiting)
    if (static_cast<double>(pieces.voxels[n].size()) >= least)
      for (const std::size_t v : pieces.voxels[n]) joined.voxels[v] = 1;
  return joined;
}

}  // namespace trocar::xray::detail
