#pragma once

#include <string>
#include <string_view>

#include "scene/stereo.h"
#include "volume/image.h"

class vtkRenderWindow;

namespace trocar::detail {

/// VTK's number of a stereo mode.
int to_vtk(StereoMode mode);
RgbImage mirrored(const RgbImage& image, bool left_right, bool up_down);
/// OpenGL's name of what draws; "" before the window has a context.
std::string renderer_of(vtkRenderWindow& window);
/// Whether a renderer of that name is a program on the processor.
bool is_by_processor(std::string_view renderer_name);

}  // namespace trocar::detail
