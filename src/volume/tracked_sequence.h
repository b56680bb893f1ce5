#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trocar {

/// 2D gray images with where they were taken, as a tracker said it: what PLUS and 3D Slicer write as .igs.mha. Outside
/// names stay: "ProbeToTracker" maps points of Probe to Tracker and is X_TrackerProbe here. Matrices, since
/// calibrations (ImageToProbe) scale pixels to mm.
struct TrackedSequence {
  using Matrix4 = Eigen::Matrix4d;

  struct Frame {
    double time_s = 0.0;
    bool is_valid = true;                       ///< ImageStatus is OK.
    std::map<std::string, Matrix4> transforms;  ///< "ProbeToTracker" -> matrix; only those whose status is OK.
  };

  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;  ///< Frame by frame, row by row.
  std::vector<Frame> frames;
  std::string image_orientation;  ///< UltrasoundImageOrientation, "MFA": marked to the right, far down.
};

}  // namespace trocar
