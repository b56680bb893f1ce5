#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "image/image.h"
#include "scene/camera.h"
#include "scene/scene_options.h"

namespace trocar::scene {

struct SceneOptions {
  int columns = 1000;  ///< Range 16..8192.
  int rows = 900;      ///< Range 16..8192.
  CameraPreset camera = CameraPreset::kRightAnteriorOblique;
  std::optional<CameraView> view = {};     ///< Instead of `camera`, which shows all surfaces.
  double skin_opacity = 0.15;              ///< Range 0..1; at 0 the skin is not drawn.
  std::vector<anatomy::NeedlePath> paths;  ///< Drawn as needles that end at their targets.
};

/// True if there is an X server with OpenGL: Debian's VTK requires one and aborts without it.
bool can_render() noexcept;

/// A 3D image of the patient's surfaces, rendered off-screen: bone ivory, other structures in the colours of the label
/// table, the skin and the organs around a target translucent; fat and muscle, which would hide the others, are not
/// drawn. Error: no X server (run under xvfb-run).
Result<image::RgbImage> render_patient(const anatomy::VirtualPatient& patient,
                                       const std::vector<anatomy::NamedMesh>& meshes, const SceneOptions& options = {});

}  // namespace trocar::scene

class vtkRenderWindow;

namespace trocar::scene::detail {

/// VTK's number of a stereo mode; quad-buffer mode draws one eye per call.
int to_vtk(StereoMode mode, Eye eye);
/// Copies the window's image as 0xffRRGGBB, top row first.
void copy_picture(vtkRenderWindow& window, std::span<std::uint32_t> pixels);
/// Reverses rows, columns or both.
void mirror(std::span<std::uint32_t> pixels, int columns, bool left_right, bool up_down);
/// OpenGL's renderer name; "" before the window has a context.
std::string renderer_of(vtkRenderWindow& window);
/// True if the renderer of that name is a software renderer.
bool is_software_renderer(std::string_view renderer_name);

}  // namespace trocar::scene::detail
