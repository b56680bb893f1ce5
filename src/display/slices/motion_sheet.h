#pragma once

#include "anatomy/patient.h"
#include "image/image.h"
#include "motion/motion_model.h"
#include "volume/sampling.h"

namespace trocar::slices {

/// A picture of how a patient moves: a coronal slice above a sagittal one through `middle_A`, each at `from`, at `to`
/// (values of the drivers), and how far the tissue went between them: colours from dark blue (0) over green to red
/// (`most_mm`), with arrows along the motion, half as long again as it is. `middle_A`: a point of the liver.
struct MotionSheet {
  motion::MotionModel::Scalars from{}, to{};
  Vec3 middle_A = Vec3::Zero();
  double most_mm = 25.0;
  int panel_pixels = 420;  ///< Width of one of the six panels. Range 64..2000.
};
image::RgbImage paint_motion(const anatomy::VirtualPatient& patient, const motion::MotionModel& model,
                             const MotionSheet& sheet);

/// A plane that looks at the whole of the patient through a point, `pixels` wide: coronal as seen from the front
/// (patient's right on the left), sagittal from the patient's left (front on the left); head up.
volume::SlicePlane whole_coronal(const volume::GridGeometry& grid, const Vec3& middle, int pixels);
volume::SlicePlane whole_sagittal(const volume::GridGeometry& grid, const Vec3& middle, int pixels);

}  // namespace trocar::slices
