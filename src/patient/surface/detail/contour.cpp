#include "surface/detail/contour.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkSmartPointer.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/progress.h"

namespace trocar::surface::detail {
namespace {

constexpr int kFull = 255;
constexpr double kFewTriangles = 1000.0;  // assumed: a mesh this small is not simplified

/// The grid with an empty voxel around it, so that its contour is closed.
vtkNew<vtkImageData> to_vtk(const volume::Grid<std::uint8_t>& grid) {
  const auto& size = grid.geometry.size;
  const Vec3& spacing_mm = grid.geometry.spacing_mm;
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(size[0]) + 2, static_cast<int>(size[1]) + 2, static_cast<int>(size[2]) + 2);
  image->SetSpacing(spacing_mm.x(), spacing_mm.y(), spacing_mm.z());
  image->SetOrigin(-spacing_mm.x(), -spacing_mm.y(), -spacing_mm.z());
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  auto* voxels = static_cast<std::uint8_t*>(image->GetScalarPointer());
  const std::int64_t row = size[0] + 2;
  std::fill_n(voxels, row * (size[1] + 2) * (size[2] + 2), std::uint8_t{0});
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j)
      std::copy_n(grid.voxels.data() + grid.geometry.offset({0, j, k}), size[0],
                  voxels + ((k + 1) * (size[1] + 2) + j + 1) * row + 1);
  }
  return image;
}

TriangleMesh from_vtk(vtkPolyData& surface) {
  TriangleMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(surface.GetNumberOfPoints()));
  for (vtkIdType n = 0; n < surface.GetNumberOfPoints(); ++n) {
    double point[3];
    surface.GetPoint(n, point);
    mesh.vertices.push_back(Vec3(point[0], point[1], point[2]).cast<float>());
  }
  mesh.triangles.reserve(static_cast<std::size_t>(surface.GetNumberOfCells()));
  vtkNew<vtkIdList> corners;
  vtkCellArray* cells = surface.GetPolys();
  for (cells->InitTraversal(); cells->GetNextCell(corners);) {
    if (corners->GetNumberOfIds() != 3) continue;
    const auto corner = [&](vtkIdType c) { return static_cast<std::uint32_t>(corners->GetId(c)); };
    mesh.triangles.push_back({corner(0), corner(1), corner(2)});
  }
  return mesh;
}

/// Runs a filter; ends it early where the work is cancelled. An exception must not pass through VTK.
void run(vtkAlgorithm& filter) {
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    if (cancellation_token().stop_requested()) static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
  });
  filter.AddObserver(vtkCommand::ProgressEvent, stop);
  cancellation_point();
  filter.Update();
  cancellation_point();
}

vtkSmartPointer<vtkPolyData> low_passed(vtkPolyData& surface, const SurfaceOptions& options) {
  vtkNew<vtkWindowedSincPolyDataFilter> filter;
  filter->SetInputData(&surface);
  filter->SetNumberOfIterations(options.smoothing_iterations);
  filter->SetPassBand(options.smoothing_pass_band);
  filter->BoundarySmoothingOff();
  filter->FeatureEdgeSmoothingOff();
  filter->NonManifoldSmoothingOn();
  run(*filter);
  return filter->GetOutput();
}

Vec3 mean_vertex(vtkPolyData& surface) {
  Vec3 sum = Vec3::Zero();
  for (vtkIdType n = 0; n < surface.GetNumberOfPoints(); ++n) sum += Vec3(surface.GetPoint(n));
  return sum / static_cast<double>(surface.GetNumberOfPoints());
}

/// The filter is linear, but its window (Hamming, before VTK 9.4) scales all coordinates by about 1.002 or 0.998. A
/// small tetrahedron far from the origin measures this factor.
double filter_gain(const SurfaceOptions& options) {
  constexpr double kFarMm = 1000.0;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
    points->InsertNextPoint(corner.x() + kFarMm, corner.y(), corner.z());
  vtkNew<vtkCellArray> triangles;
  for (const auto& [a, b, c] : {std::array<vtkIdType, 3>{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}) {
    const vtkIdType corners[3] = {a, b, c};
    triangles->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> tetrahedron;
  tetrahedron->SetPoints(points);
  tetrahedron->SetPolys(triangles);
  return mean_vertex(*low_passed(*tetrahedron, options)).x() / kFarMm;
}

/// Low-pass filter without scaling.
vtkSmartPointer<vtkPolyData> smoothed(vtkPolyData& surface, const SurfaceOptions& options) {
  vtkSmartPointer<vtkPolyData> result = low_passed(surface, options);
  const double gain = filter_gain(options);
  vtkPoints* points = result->GetPoints();
  for (vtkIdType n = 0; n < points->GetNumberOfPoints(); ++n) {
    const Vec3 p = Vec3(points->GetPoint(n)) / gain;
    points->SetPoint(n, p.data());
  }
  return result;
}

/// False if a coarser grid would lose thin walls: too much of the mask lies in voxels that are partly filled, which a
/// contour at one half takes as full or as empty.
bool keeps_shape(const volume::Grid<std::uint8_t>& occupancy) {
  constexpr double kMostWrong = 0.10;  // assumed: organs of 1 l at 4 mm have 8 %, a bowel's wall of 3 mm at 2 mm 13 %
  double wrong = 0.0, filled = 0.0;
  for (const std::uint8_t value : occupancy.voxels) {
    filled += value;
    wrong += std::min<int>(value, kFull - value);
  }
  return wrong <= kMostWrong * filled;
}

}  // namespace

volume::Grid<std::uint8_t> occupancy(const volume::MaskGrid& mask, double spacing_mm) {
  const volume::GridGeometry& fine = mask.geometry;
  volume::Index3 factor;
  volume::GridGeometry coarse = fine;
  Vec3 first_centre;  // of the first coarse voxel, in fine indices
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    factor[a] = std::max<std::int64_t>(1, std::lround(spacing_mm / fine.spacing_mm[axis]));
    coarse.size[a] = (fine.size[a] + factor[a] - 1) / factor[a];
    coarse.spacing_mm[axis] = fine.spacing_mm[axis] * static_cast<double>(factor[a]);
    first_centre[axis] = 0.5 * static_cast<double>(factor[a] - 1);
  }
  coarse.origin_P = fine.to_mm(first_centre);

  std::vector<int> counts(coarse.voxel_count(), 0);
  std::size_t n = 0;
  for (std::int64_t k = 0; k < fine.size[2]; ++k) {
    for (std::int64_t j = 0; j < fine.size[1]; ++j) {
      int* row = counts.data() + coarse.offset({0, j / factor[1], k / factor[2]});
      for (std::int64_t i = 0; i < fine.size[0]; ++i) row[i / factor[0]] += mask.voxels[n++];
    }
  }
  volume::Grid<std::uint8_t> filled(coarse);
  const auto block = static_cast<int>(factor[0] * factor[1] * factor[2]);
  for (n = 0; n < counts.size(); ++n) filled.voxels[n] = static_cast<std::uint8_t>(counts[n] * kFull / block);
  return filled;
}

std::size_t count_faces(const volume::Grid<std::uint8_t>& occupancy) {
  const auto& size = occupancy.geometry.size;
  const std::array<std::int64_t, 3> step{1, size[0], size[0] * size[1]};
  const auto is_filled = [&](std::int64_t n) { return 2 * occupancy.voxels[static_cast<std::size_t>(n)] > kFull; };
  std::size_t faces = 0;
  std::int64_t n = 0;
  for (volume::Index3 ijk{0, 0, 0}; ijk[2] < size[2]; ++ijk[2])
    for (ijk[1] = 0; ijk[1] < size[1]; ++ijk[1])
      for (ijk[0] = 0; ijk[0] < size[0]; ++ijk[0], ++n)
        for (std::size_t a = 0; a < 3; ++a) {
          const bool next = ijk[a] + 1 < size[a] && is_filled(n + step[a]);
          faces += is_filled(n) != next ? 1 : 0;
          faces += ijk[a] == 0 && is_filled(n) ? 1 : 0;
        }
  return faces;
}

volume::Grid<std::uint8_t> bounded_occupancy(const volume::MaskGrid& mask, double spacing_mm, std::size_t wanted_faces,
                                             std::size_t max_faces) {
  volume::Grid<std::uint8_t> grid = occupancy(mask, spacing_mm);
  for (std::size_t faces = count_faces(grid); faces > wanted_faces; faces = count_faces(grid)) {
    cancellation_point();
    volume::Grid<std::uint8_t> coarser = occupancy(mask, 2.0 * grid.geometry.spacing_mm.minCoeff());
    if (faces <= max_faces && !keeps_shape(coarser)) break;
    grid = std::move(coarser);
  }
  return grid;
}

TriangleMesh contour(const volume::Grid<std::uint8_t>& occupancy, const SurfaceOptions& options) {
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(to_vtk(occupancy));
  edges->SetValue(0, 0.5 * kFull);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->ComputeScalarsOff();
  run(*edges);
  vtkSmartPointer<vtkPolyData> surface = edges->GetOutput();

  if (options.smoothing_iterations > 0) surface = smoothed(*surface, options);
  const auto triangles = static_cast<double>(surface->GetNumberOfCells());
  const double kept = std::min(options.decimate_to_fraction, static_cast<double>(options.max_triangles) / triangles);
  if (kept < 1.0 && triangles > kFewTriangles) {
    vtkNew<vtkQuadricDecimation> decimate;
    decimate->SetInputData(surface);
    decimate->SetTargetReduction(1.0 - kept);
    decimate->VolumePreservationOn();
    run(*decimate);
    surface = decimate->GetOutput();
  }

  TriangleMesh mesh = from_vtk(*surface);
  close_holes(mesh);
  if (enclosed_volume_mm3(mesh) < 0.0) {
    for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  }
  return mesh;
}

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
