#include "xray/contrast/detail/duct_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::xray::detail {
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
