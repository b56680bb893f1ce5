#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "core/progress.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "registration/shadow/beams.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Start of the rigid registration.
struct RigidOptions {
  Pose X_CU;                           ///< First estimate: points of the ultrasound to points of the CT (mm).
  bool is_search = false;              ///< Also start from poses with the transducer on the skin of the CT.
  double reach_mm = 25.0;              ///< Mean displacement from X_CU allowed without search. Range 1..200.
  std::uint64_t seed = 1;              ///< Of the samples and starts.
  std::function<bool()> is_cancelled;  ///< Polled between steps; may be empty.
};

struct RigidRegistration {
  Pose X_CU;                  ///< Points of the ultrasound to points of the CT (mm).
  double metric = 0.0;        ///< Mutual information, nats.
  double overlap = 0.0;       ///< Share of the usable ultrasound inside the CT, 0..1.
  double confidence = 0.0;    ///< 0..1 (docs/physics.md R13).
  double agreement = 0.0;     ///< Share of the starts that led to this pose, 0..1.
  double distinction = 0.0;   ///< Metric above that of displaced poses, in their standard deviations.
  double shadow_share = 0.0;  ///< Of the image, 0..1.
};

/// Results below it are not to be used.
inline constexpr double kLeastConfidence = 0.5;
/// Error: a confidence below it. `unchanged`: what the caller left as it was, for the text.
Status check_confidence(const RigidRegistration& found, std::string_view unchanged);

/// Finds the pose of an ultrasound volume in a CT by mutual information of local contrasts, on samples that are neither
/// shadow nor beside the image (docs/physics.md R11 to R13). The result may have a low confidence: compare it with
/// check_confidence(). Bitwise independent of the number of threads. Errors: a constant or shadowed ultrasound, volumes
/// that do not overlap, cancelled.
Result<RigidRegistration> register_rigid(const volume::CtGrid& ct, const volume::LabelGrid& us, const Beams& beams,
                                         const RigidOptions& options, const Progress& progress = {});

/// Mean distance (mm) between two poses over the usable voxels of an ultrasound volume.
Result<double> mean_distance_mm(const volume::LabelGrid& us, const Beams& beams, const Pose& X_a, const Pose& X_b);

/// Voxels whose gray levels are compared: imaged, and neither shadow nor near one. On the grid of the ultrasound if its
/// voxels are larger than 0.8 mm, else on blocks of it.
Result<volume::MaskGrid> usable_voxels(const volume::LabelGrid& us, const Beams& beams);

}  // namespace trocar::registration
