#include "surface/detail/mesh_repair.h"

#include <algorithm>
#include <map>
#include <utility>

namespace trocar::surface::detail {
namespace {

/// A directed edge without its opposite, packed for sorting.
struct HalfEdge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  int direction = 0;  ///< 1: from low to high index, -1: reverse.
};

/// The missing directed edges: at each vertex, as many leave as arrive.
std::multimap<std::uint32_t, std::uint32_t> missing_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangle[c];
      const std::uint32_t b = triangle[(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
  std::multimap<std::uint32_t, std::uint32_t> missing;
  for (std::size_t n = 0; n < edges.size();) {
    const HalfEdge& edge = edges[n];
    int surplus = 0;
    for (; n < edges.size() && edges[n].low == edge.low && edges[n].high == edge.high; ++n)
      surplus += edges[n].direction;
    for (; surplus > 0; --surplus) missing.emplace(edge.high, edge.low);
    for (; surplus < 0; ++surplus) missing.emplace(edge.low, edge.high);
  }
  return missing;
}

}  // namespace

void close_holes(TriangleMesh& mesh) {
  auto missing = missing_edges(mesh);
  while (!missing.empty()) {
    const std::uint32_t start = missing.begin()->first;
    std::uint32_t here = start;
    for (auto edge = missing.find(here); edge != missing.end(); edge = missing.find(here)) {
      const std::uint32_t next = edge->second;
      missing.erase(edge);
      if (here != start && next != start) mesh.triangles.push_back({start, here, next});
      here = next;
      if (here == start) break;
    }
  }
}

void restore_volume(TriangleMesh& mesh, double volume_mm3, double max_shift_mm) {
  const double area = area_mm2(mesh);
  if (!(area > 0.0)) return;
  const double shift_mm = std::clamp((volume_mm3 - enclosed_volume_mm3(mesh)) / area, -max_shift_mm, max_shift_mm);
  std::vector<Vec3f> normals(mesh.vertices.size(), Vec3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3f normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);  // weighted by area
    normals[a] += normal;
    normals[b] += normal;
    normals[c] += normal;
  }
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    mesh.vertices[n] += static_cast<float>(shift_mm) * normals[n].normalized();
}

}  // namespace trocar::surface::detail
