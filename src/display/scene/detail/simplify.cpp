#include "scene/detail/simplify.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include <cmath>
#include <numbers>
#include <unordered_map>

namespace trocar::scene::detail {
namespace {

float mean_edge_mm(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).norm();
  return static_cast<float>(sum / static_cast<double>(mesh.triangles.size()));
}

/// 21 bits per coordinate: cells down to a thousandth of a millimetre in a body of two metres.
std::uint64_t cell_of(const Vec3f& p, float cell_mm) {
  constexpr std::int64_t kOffset = 1 << 20;
  const auto part = [&](float v) {
    return static_cast<std::uint64_t>((static_cast<std::int64_t>(std::floor(v / cell_mm)) + kOffset) & 0x1FFFFF);
  };
  return part(p.x()) << 42 | part(p.y()) << 21 | part(p.z());
}

}  // namespace

SimplifiedMesh simplify(const TriangleMesh& mesh, const std::vector<Vec3f>& normals, double coarseness) {
  if (mesh.triangles.empty()) return {mesh, normals};
  const float cell_mm = static_cast<float>(coarseness) * mean_edge_mm(mesh);
  if (!(cell_mm > 0.0F)) return {mesh, normals};
  SimplifiedMesh simplified;
  TriangleMesh& result = simplified.mesh;
  std::unordered_map<std::uint64_t, std::uint32_t> ids;
  ids.reserve(mesh.vertices.size() / 2);
  std::vector<std::uint32_t> id_of(mesh.vertices.size());
  std::vector<float> counts;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto [entry, is_new] =
        ids.try_emplace(cell_of(mesh.vertices[v], cell_mm), static_cast<std::uint32_t>(result.vertices.size()));
    if (is_new) {
      result.vertices.push_back(Vec3f::Zero());
      simplified.normals.push_back(Vec3f::Zero());
      counts.push_back(0.0F);
    }
    id_of[v] = entry->second;
    result.vertices[entry->second] += mesh.vertices[v];
    simplified.normals[entry->second] += normals[v];
    counts[entry->second] += 1.0F;
  }
  for (std::size_t v = 0; v < counts.size(); ++v) {
    result.vertices[v] /= counts[v];
    const float length = simplified.normals[v].norm();
    if (length > 0.0F) simplified.normals[v] /= length;
  }
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> corners = {id_of[t[0]], id_of[t[1]], id_of[t[2]]};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
      result.triangles.push_back(corners);
    }
  }
  return simplified;
}

SimplifiedMesh decimate(const TriangleMesh& mesh, double keep) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.triangles) {
    const vtkIdType corners[3] = {triangle[0], triangle[1], triangle[2]};
    cells->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkQuadricDecimation> filter;
  filter->SetInputData(data);
  filter->SetTargetReduction(1.0 - keep);
  filter->Update();

  SimplifiedMesh result;
  vtkPolyData& coarse = *filter->GetOutput();
  for (vtkIdType i = 0; i < coarse.GetNumberOfPoints(); ++i) {
    result.mesh.vertices.push_back(Vec3(coarse.GetPoint(i)).cast<float>());
  }
  const auto to_id = [](vtkIdType id) { return static_cast<std::uint32_t>(id); };
  vtkIdType count = 0;
  const vtkIdType* corners = nullptr;
  for (coarse.GetPolys()->InitTraversal(); coarse.GetPolys()->GetNextCell(count, corners) != 0;) {
    if (count == 3) result.mesh.triangles.push_back({to_id(corners[0]), to_id(corners[1]), to_id(corners[2])});
  }
  result.normals = vertex_normals(result.mesh);
  return result;
}

std::vector<Vec3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3f> normals(mesh.vertices.size(), Vec3f::Zero());
  for (const auto& t : mesh.triangles) {
    const Vec3f& a = mesh.vertices[t[0]];
    const Vec3f twice_area = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    for (const std::uint32_t corner : t) normals[corner] += twice_area;
  }
  for (Vec3f& n : normals) {
    const float length = n.norm();
    if (length > 0.0F) n /= length;
  }
  return normals;
}

std::optional<double> first_hit_mm(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction) {
  // The intersection in barycentric coordinates (Möller and Trumbore, 1997).
  std::optional<double> nearest_mm;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>();
    const Vec3 edge_b = mesh.vertices[t[1]].cast<double>() - a;
    const Vec3 edge_c = mesh.vertices[t[2]].cast<double>() - a;
    const Vec3 square = direction.cross(edge_c);
    const double area = edge_b.dot(square);
    if (std::abs(area) < 1e-12) continue;
    const Vec3 from_a = origin - a;
    const double u = from_a.dot(square) / area;
    if (u < 0.0 || u > 1.0) continue;
    const Vec3 other = from_a.cross(edge_b);
    const double v = direction.dot(other) / area;
    if (v < 0.0 || u + v > 1.0) continue;
    const double along_mm = edge_c.dot(other) / area;
    if (along_mm > 0.0 && (!nearest_mm || along_mm < *nearest_mm)) nearest_mm = along_mm;
  }
  return nearest_mm;
}

namespace {

std::uint32_t add_point(TriangleMesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// A lid with its own points, so that the edge stays sharp.
void add_lid(TriangleMesh& mesh, const std::vector<Vec3>& ring, bool faces_forward) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : ring) middle += p;
  const std::uint32_t center = add_point(mesh, middle / static_cast<double>(ring.size()));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : ring) add_point(mesh, p);
  const auto count = static_cast<std::uint32_t>(ring.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = first + (i + 1) % count;
    mesh.triangles.push_back(faces_forward ? std::array{center, a, b} : std::array{center, b, a});
  }
}

}  // namespace

TriangleMesh make_loft(const std::vector<std::vector<Vec3>>& rings) {
  TriangleMesh mesh;
  const auto sides = static_cast<std::uint32_t>(rings.front().size());
  for (const auto& ring : rings) {
    for (const Vec3& p : ring) add_point(mesh, p);
  }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t next = (s + 1) % sides;
      const std::uint32_t low = r * sides;
      const std::uint32_t high = low + sides;
      mesh.triangles.push_back({low + s, low + next, high + next});
      mesh.triangles.push_back({low + s, high + next, high + s});
    }
  }
  add_lid(mesh, rings.front(), false);
  add_lid(mesh, rings.back(), true);
  return mesh;
}

TriangleMesh make_turned(const Pose& X_AL, std::span<const Ring> rings, int sides) {
  std::vector<std::vector<Vec3>> circles;
  for (const Ring& ring : rings) {
    std::vector<Vec3> circle;
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sides;
      circle.push_back(X_AL * Vec3(ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z));
    }
    circles.push_back(std::move(circle));
  }
  return make_loft(circles);
}

TriangleMesh make_box(const Pose& X_AL, const Vec3& half_mm, double corner_mm) {
  constexpr int kStepsOfCorner = 4;
  std::vector<std::vector<Vec3>> outlines;
  for (const double z : {-half_mm.z(), half_mm.z()}) {
    std::vector<Vec3> outline;
    for (int corner = 0; corner < 4; ++corner) {
      const double sx = corner == 0 || corner == 3 ? 1.0 : -1.0;
      const double sy = corner < 2 ? 1.0 : -1.0;
      for (int step = 0; step <= kStepsOfCorner; ++step) {
        const double angle = 0.5 * std::numbers::pi * (corner + static_cast<double>(step) / kStepsOfCorner);
        outline.push_back(X_AL * Vec3(sx * (half_mm.x() - corner_mm) + corner_mm * std::cos(angle),
                                      sy * (half_mm.y() - corner_mm) + corner_mm * std::sin(angle), z));
      }
    }
    outlines.push_back(std::move(outline));
  }
  return make_loft(outlines);
}

}  // namespace trocar::scene::detail
