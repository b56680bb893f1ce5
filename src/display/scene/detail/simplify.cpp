#include "scene/detail/simplify.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include <cmath>
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

}  // namespace trocar::scene::detail
