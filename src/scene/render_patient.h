#pragma once

#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "volume/image.h"

namespace trocar {

/// A camera position around the patient.
enum class CameraPreset { kAnterior, kRightAnteriorOblique, kRight, kPosterior };

struct SceneOptions {
  int columns = 1000;
  int rows = 900;
  CameraPreset camera = CameraPreset::kRightAnteriorOblique;
  double skin_opacity = 0.15;
  std::vector<NeedlePath> paths;  ///< Drawn as needles.
};

/// A 3D picture of the patient's surfaces, off-screen. Needs an X server (VTK on Debian has no other): without one an
/// error that says so (run under xvfb-run).
Result<RgbImage> render_patient(const VirtualPatient& patient, const std::vector<NamedMesh>& meshes,
                                const SceneOptions& options = {});

}  // namespace trocar
