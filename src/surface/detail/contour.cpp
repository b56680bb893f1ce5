#include "surface/detail/contour.h"

#include <vtkCellArray.h>
#include <vtkDecimatePro.h>
#include <vtkDiscreteFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>

namespace trocar::detail {
namespace {

constexpr std::size_t kFewTriangles = 1000;  // assumed: a mesh this small is drawn as it is

/// The mask with an empty voxel around it, so that its contour closes.
vtkNew<vtkImageData> to_vtk(const MaskGrid& mask) {
  const auto& size = mask.geometry.size;
  const Vec3& spacing_mm = mask.geometry.spacing_mm;
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
      std::copy_n(mask.voxels.data() + mask.geometry.offset({0, j, k}), size[0],
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

}  // namespace

TriangleMesh contour(const MaskGrid& mask, const SurfaceOptions& options) {
  vtkNew<vtkDiscreteFlyingEdges3D> edges;
  edges->SetInputData(to_vtk(mask));
  edges->SetValue(0, 1);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  vtkSmartPointer<vtkPolyData> surface = edges->GetOutput();

  if (options.smoothing_iterations > 0) {
    vtkNew<vtkWindowedSincPolyDataFilter> smooth;
    smooth->SetInputData(surface);
    smooth->SetNumberOfIterations(options.smoothing_iterations);
    smooth->SetPassBand(options.smoothing_pass_band);
    smooth->BoundarySmoothingOff();
    smooth->FeatureEdgeSmoothingOff();
    smooth->NonManifoldSmoothingOn();
    smooth->NormalizeCoordinatesOn();
    smooth->Update();
    surface = smooth->GetOutput();
  }
  if (options.decimate_to_fraction < 1.0 && surface->GetNumberOfCells() > static_cast<vtkIdType>(kFewTriangles)) {
    vtkNew<vtkDecimatePro> decimate;
    decimate->SetInputData(surface);
    decimate->SetTargetReduction(1.0 - options.decimate_to_fraction);
    decimate->PreserveTopologyOn();
    decimate->SplittingOff();
    decimate->BoundaryVertexDeletionOff();
    decimate->Update();
    surface = decimate->GetOutput();
  }

  TriangleMesh mesh = from_vtk(*surface);
  if (enclosed_volume_mm3(mesh) < 0.0) {
    for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  }
  return mesh;
}

void restore_volume(TriangleMesh& mesh, double volume_mm3, double max_shift_mm) {
  const double area = area_mm2(mesh);
  if (!(area > 0.0)) return;
  const double shift_mm = std::clamp((volume_mm3 - enclosed_volume_mm3(mesh)) / area, -max_shift_mm, max_shift_mm);
  std::vector<Vec3f> normals(mesh.vertices.size(), Vec3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3f normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);  // weighs by area
    normals[a] += normal;
    normals[b] += normal;
    normals[c] += normal;
  }
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    mesh.vertices[n] += static_cast<float>(shift_mm) * normals[n].normalized();
}

}  // namespace trocar::detail
