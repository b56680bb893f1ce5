#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "registration/shadow/beams.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/probe/transducer.h"
#include "ultrasound/sweep/tracked_sequence.h"

/// Volumes with known poses for the benchmark of stitching.
namespace trocar::bench {

struct KnownVolume {
  volume::LabelGrid gray;
  registration::Beams beams;
  Pose X_WU;  ///< From the volume's frame to a common one.
};

/// The embedded patient before a mechanical 3D transducer.
struct SweepScene {
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  ultrasound::Transducer transducer;
  Pose X_PT;  ///< Below the ribs, through the liver to the diaphragm.
};
Result<SweepScene> open_sweep_scene();

/// Six sweeps of 120 mm depth at 1 mm; `turn_deg`: about the angle between neighbours. `is_straight`: without
/// refraction and range distortion, so that the pictures are rigid.
Result<std::vector<KnownVolume>> make_sweeps(const SweepScene& scene, double turn_deg, bool is_straight);

/// Index axes of a reconstructed sweep.
struct MainDirections {
  int motion = 2;  ///< Axis along which the transducer moved.
  std::string beam = "+y";
};
Result<MainDirections> main_directions(const ultrasound::TrackedSequence& sequence,
                                       const volume::GridGeometry& geometry);

}  // namespace trocar::bench
