#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/pose.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/scanner/display_settings.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

// Poses X_PT of a hand's sweep about the pose in the middle; frames >= 2.

/// Moves along z of T over the skin. Each pose is shifted along y so that the middle of the face is as deep as at the
/// middle pose.
std::vector<Pose> slide_over_skin(const volume::FloatGrid& skin_distance_mm, const Pose& X_PT, double length_mm,
                                  int frames);
/// Rotates about the line y = -radius_mm, z = 0 of T; radius 0: about the face.
std::vector<Pose> tilt_on_skin(const Pose& X_PT, double angle_rad, double radius_mm, int frames);

/// Small random motion of a hand at one of many frames: at most 4 mm and 3 degrees.
Pose sway(const Pose& X_PT, int frame) noexcept;

struct FreehandSweepOptions {
  Acquisition acquisition;
  DisplaySettings display;  ///< Mirroring has no effect here.
  int columns = 640;        ///< Range 16..4096.
  int rows = 480;           ///< Range 1..4096.
  double frames_per_s = 20.0;
  std::uint64_t seed = 1;  ///< Seed of the receiver's noise.
};

struct FreehandSweep {
  TrackedSequence sequence;
  double mean_contact = 1.0;  ///< Share of all pictures' scanlines that are coupled to the skin.
};

/// Makes a freehand sweep in the form of a PLUS recording. One sensor is on the transducer ("Probe"), another one on
/// the patient ("Reference", whose axes are those of P). A tracker gives ProbeToTracker and ReferenceToTracker of each
/// frame; ImageToProbe is the calibration. Columns run along +x of T, rows along +y. The positions of the sensors and
/// of the tracker are assumed.
FreehandSweep make_freehand_sweep(const std::shared_ptr<const AcousticScene>& scene, const Transducer& transducer,
                                  std::span<const Pose> X_PT, const FreehandSweepOptions& options,
                                  const Progress& progress = {});

}  // namespace trocar::ultrasound
