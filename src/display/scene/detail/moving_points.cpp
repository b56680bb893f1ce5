#include "scene/detail/moving_points.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include "core/parallel.h"

namespace trocar::scene::detail {
namespace {

constexpr std::size_t kPointsTogether = 2048;

std::vector<Vec3f> copy_of(vtkDataArray& values) {
  std::vector<Vec3f> copy(static_cast<std::size_t>(values.GetNumberOfTuples()));
  for (std::size_t n = 0; n < copy.size(); ++n) {
    double tuple[3];
    values.GetTuple(static_cast<vtkIdType>(n), tuple);
    copy[n] = Vec3(tuple[0], tuple[1], tuple[2]).cast<float>();
  }
  return copy;
}

void put(vtkDataArray& values, std::size_t n, const Vec3& v) {
  values.SetTuple(static_cast<vtkIdType>(n), v.data());
}

}  // namespace

bool MovingPoints::move(const motion::PatientMotion& motion) {
  if (data_ == nullptr || motion.is_same_place(shown_)) return false;
  shown_ = motion;
  vtkDataArray& points = *data_->GetPoints()->GetData();
  vtkDataArray& normals = *data_->GetPointData()->GetNormals();
  if (points_A_.empty()) {
    points_A_ = copy_of(points);
    normals_A_ = copy_of(normals);
  }
  parallel_for(points_A_.size(), kPointsTogether, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Vec3 p_A = points_A_[n].cast<double>(), normal_A = normals_A_[n].cast<double>();
      put(points, n, motion.to_now(p_A));
      put(normals, n, motion.is_rest() ? normal_A : motion.gradient_to_now(p_A, normal_A).normalized());
    }
  });
  data_->GetPoints()->Modified();
  data_->GetPointData()->GetNormals()->Modified();
  data_->Modified();
  return true;
}

TriangleMesh moved_mesh(TriangleMesh mesh_A, const motion::PatientMotion& motion) {
  if (!motion.is_rest())
    for (Vec3f& vertex : mesh_A.vertices) vertex = motion.to_now(vertex.cast<double>()).cast<float>();
  return mesh_A;
}

}  // namespace trocar::scene::detail
