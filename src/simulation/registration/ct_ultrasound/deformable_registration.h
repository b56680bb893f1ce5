#pragma once

#include <functional>

#include "core/progress.h"
#include "registration/ct_ultrasound/rigid_registration.h"
#include "volume/spline_field.h"

namespace trocar::registration {

/// Refinement of a rigid registration (docs/physics.md R20).
struct DeformableOptions {
  double node_mm = 28.0;          ///< Distance of the spline's nodes. Range 10..100. Assumed.
  double bending_per_mm2 = 3e-3;  ///< Weight of the bending energy against nats. Range 1e-6..1. Assumed.
  int most_steps = 40;            ///< Of the optimiser. Range 1..1000.
  std::uint64_t seed = 1;         ///< Of the samples.
  std::function<bool()> is_cancelled;
};

struct DeformableRegistration {
  volume::SplineField field_U;  ///< Points of the CT: X_CU * (p + u(p)), p in the ultrasound.
  double metric_before = 0.0;   ///< Mutual information of the samples at the rigid pose, nats.
  double metric = 0.0;          ///< With the displacements.
  double mean_mm = 0.0;         ///< Mean and largest displacement of the usable voxels.
  double largest_mm = 0.0;
  double least_jacobian = 1.0;  ///< Over the usable voxels; above 0: no folding.
};

/// Finds smooth displacements on top of a rigid pose: mutual information (R12) of a tenth of the voxels minus the
/// bending energy of the spline. Deterministic. Errors: those of register_rigid, a result that folds space.
Result<DeformableRegistration> register_deformable(const volume::CtGrid& ct, const volume::LabelGrid& us,
                                                   const Beams& beams, const Pose& X_CU,
                                                   const DeformableOptions& options, const Progress& progress = {});

}  // namespace trocar::registration
