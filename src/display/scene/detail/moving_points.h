#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "motion/patient_motion.h"

namespace trocar::scene::detail {

/// Points and normals of a surface at rest (frame A), which can be set to where they are now. Without motion the data
/// is left as it is.
class MovingPoints {
 public:
  MovingPoints() = default;
  explicit MovingPoints(vtkSmartPointer<vtkPolyData> data) : data_(std::move(data)) {}

  /// True if it changed the data. All cores.
  bool move(const motion::PatientMotion& motion);

 private:
  vtkSmartPointer<vtkPolyData> data_;
  std::vector<Vec3f> points_A_, normals_A_;  ///< Empty until the patient first moves.
  motion::PatientMotion shown_;
};

/// A mesh at rest as it is now.
TriangleMesh moved_mesh(TriangleMesh mesh_A, const motion::PatientMotion& motion);

}  // namespace trocar::scene::detail
