#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/stereo.h"

class vtkRenderWindow;

namespace trocar::scene::detail {

/// VTK's number of a stereo mode; quad-buffer draws one eye at a time.
int to_vtk(StereoMode mode, Eye eye);
/// The window's picture as 0xffRRGGBB, rows from the top.
void copy_picture(vtkRenderWindow& window, std::span<std::uint32_t> pixels);
/// Rows, columns or both in reverse.
void mirror(std::span<std::uint32_t> pixels, int columns, bool left_right, bool up_down);
/// OpenGL's name of what draws; "" before the window has a context.
std::string renderer_of(vtkRenderWindow& window);
/// Whether a renderer of that name is a program on the processor.
bool is_software_renderer(std::string_view renderer_name);

}  // namespace trocar::scene::detail
