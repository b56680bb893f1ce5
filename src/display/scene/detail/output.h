#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/stereo.h"

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
