#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "scene/camera.h"
#include "volume/image.h"

namespace trocar::scene {

struct SceneOptions {
  int columns = 1000;  ///< Range 16..8192.
  int rows = 900;      ///< Range 16..8192.
  CameraPreset camera = CameraPreset::kRightAnteriorOblique;
  double skin_opacity = 0.15;              ///< Range 0..1; at 0 the skin is left out.
  std::vector<anatomy::NeedlePath> paths;  ///< Drawn as needles that end at their targets.
};

/// Whether there is an X server that can draw: VTK on Debian has no other way, and aborts where it finds none.
bool can_render() noexcept;

/// A 3D picture of the patient's surfaces, off-screen: bone ivory, other structures in the colours of the label table,
/// the skin and the organs around a target translucent; fat and muscle, which would hide all, are left out.
/// An error without an X server (run under xvfb-run).
Result<volume::RgbImage> render_patient(const anatomy::VirtualPatient& patient,
                                        const std::vector<anatomy::NamedMesh>& meshes,
                                        const SceneOptions& options = {});

}  // namespace trocar::scene
